//! The tables of a universality study, and the cases that follow from them.

use std::collections::HashSet;
use std::ops::Range;
use std::path::PathBuf;

use toml::{Table, Value};

use super::cover::{combinations, covering_design};
use super::{Case, FACTORS, MOST_COMBINATIONS, Prediction, Tolerances};
use crate::error::{Error, Result};
use crate::scene::document::{Entry, Section, Source};
use crate::scene::keys;
use crate::scene::patch::{self, Patch};
use crate::scene::reading::Read;

/// Tables of the levels of each factor, in the order of [`FACTORS`].
const TABLES: [&str; 4] = ["media", "wear", "friction", "modes"];

/// What the document says, before the base scene is there.
pub(super) struct Plan {
    pub(super) title: Option<String>,
    pub(super) tolerances: Tolerances,
    pub(super) base: Base,
    full: bool,
    factors: [Vec<Level>; 4],
    without: Vec<[String; 2]>,
    singles: Vec<Single>,
}

/// The base scene.
pub(super) enum Base {
    /// In the study.
    Table(Table),
    /// In a file of its own.
    File(PathBuf),
}

/// One of the values of a factor.
struct Level {
    name: String,
    /// Where the name stands.
    place: Range<usize>,
    patch: Patch,
    /// How long a run with it lasts at least.
    tau: Option<f64>,
}

/// A case that stands for itself.
struct Single {
    level: Level,
    predicted: Prediction,
    reason: Option<String>,
    finer: bool,
}

pub(super) fn read(root: &Section, values: &Table) -> Result<Plan> {
    root.check(&keys::UNIVERSALITY)?;
    let title = root.read_optional(&keys::TITLE)?;
    let scene = root.required("scene", "give the base scene as a table, or the name of its file")?;
    let base = match values.get("scene") {
        Some(Value::Table(table)) => Base::Table(table.clone()),
        _ => Base::File(scene.string()?.into()),
    };
    let tolerances =
        root.optional(keys::TOLERANCES.name).map(|entry| tolerances(&entry.section()?)).transpose()?;
    let full = root.read::<usize>(&keys::COVER)? == 1;

    let mut names = HashSet::new();
    let mut factors: [Vec<Level>; 4] = Default::default();
    for (levels, table) in factors.iter_mut().zip(TABLES) {
        for (section, values) in entries(root, values, table)? {
            section.check(&keys::LEVEL_OF_FACTOR)?;
            levels.push(level(&section, values, &mut names)?);
        }
    }
    let product = factors.iter().map(|levels| levels.len().max(1)).fold(1usize, usize::saturating_mul);
    if product > MOST_COMBINATIONS {
        let message = format!("makes {product} combinations of levels, more than {MOST_COMBINATIONS}");
        let last =
            TABLES.iter().rev().find_map(|table| root.optional(table)).expect("levels make combinations");
        return Err(last.misplaced(message));
    }
    let mut singles = vec![];
    for (section, values) in entries(root, values, "cases")? {
        section.check(&keys::CASE)?;
        let predicted = Prediction::ALL[section.read::<usize>(&keys::PREDICTED)?];
        let reason = section.read_optional(&keys::REASON)?;
        let finer = section.read(&keys::FINER)?;
        let level = level(&section, values, &mut names)?;
        singles.push(Single { level, predicted, reason, finer });
    }
    let mut without = vec![];
    for (section, _) in entries(root, values, "without")? {
        section.check(&keys::WITHOUT)?;
        section.read_optional::<String>(&keys::REASON)?;
        without.push(pair(&section.required_key(&keys::PAIR)?, &factors)?);
    }
    if factors.iter().all(Vec::is_empty) && singles.is_empty() {
        return Err(root.error("has no case; give levels of factors, or [[cases]]"));
    }
    let tolerances = tolerances.unwrap_or_default();
    Ok(Plan { title, tolerances, base, full, factors, without, singles })
}

fn tolerances(section: &Section) -> Result<Tolerances> {
    section.check(&keys::TOLERANCES)?;
    let found = Tolerances { within: section.read(&keys::WITHIN)?, outside: section.read(&keys::OUTSIDE)? };
    match found.within < found.outside {
        true => Ok(found),
        false => Err(section.error(format_args!(
            "within = {} is not below outside = {}: what lies between them is unclear",
            found.within, found.outside
        ))),
    }
}

/// The tables of an array, with and without their places.
fn entries<'a>(root: &Section<'a>, values: &'a Table, name: &str) -> Result<Vec<(Section<'a>, &'a Table)>> {
    let Some(entry) = root.optional(name) else { return Ok(vec![]) };
    let sections = entry.array(keys::MOST_ENTRIES)?.iter().map(Entry::section).collect::<Result<Vec<_>>>()?;
    let tables = values.get(name).and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_table);
    Ok(sections.into_iter().zip(tables).collect())
}

fn level(section: &Section, values: &Table, names: &mut HashSet<String>) -> Result<Level> {
    let entry = section.required_key(&keys::NAME)?;
    let name = String::read(&entry, &keys::NAME)?;
    if name.trim() != name || name.is_empty() {
        return Err(entry.error("is empty, or begins or ends with a space"));
    }
    if !names.insert(name.clone()) {
        return Err(entry.error("is given twice; names must differ"));
    }
    if let Some(entry) = section.optional("patch") {
        entry.section()?;
    }
    let patch = Patch::new(values.get("patch").and_then(Value::as_table).unwrap_or(&Table::new()));
    if let Some([one, two]) = patch.conflict(&patch) {
        return Err(section.error(format_args!("{name}: {one} and {two} exclude each other")));
    }
    let tau = section.read_optional(&keys::LASTS)?;
    Ok(Level { name, place: entry.place(), patch, tau })
}

/// Two levels of different factors.
fn pair(entry: &Entry, factors: &[Vec<Level>; 4]) -> Result<[String; 2]> {
    let mut found = vec![];
    for entry in entry.array(2)? {
        let name = entry.string()?;
        let factor = factors.iter().position(|levels| levels.iter().any(|level| level.name == name));
        let factor = factor.ok_or_else(|| entry.error("is the name of no level"))?;
        found.push((factor, name.to_owned()));
    }
    match &found[..] {
        [(one, first), (two, second)] if one != two => Ok([first.clone(), second.clone()]),
        _ => Err(entry.error("is not two levels of different factors")),
    }
}

/// Those of a study that says nothing of them.
impl Default for Tolerances {
    fn default() -> Self {
        let read = |key| f64::default_of(key).expect("both have a default");
        Self { within: read(&keys::WITHIN), outside: read(&keys::OUTSIDE) }
    }
}

impl Plan {
    /// All cases over a base scene.
    ///
    /// # Errors
    /// [`Error::Scene`] names two levels that set one key differently.
    pub(super) fn cases(&self, base: &Table, study: Source) -> Result<Vec<Case>> {
        self.check_conflicts(study)?;
        let mut cases = vec![];
        if self.factors.iter().any(|levels| !levels.is_empty()) {
            for places in self.design() {
                let levels = self.levels(&places);
                let mut names: [String; 4] = Default::default();
                names.iter_mut().zip(&levels).for_each(|(name, level)| {
                    *name = level.map_or(String::new(), |level| level.name.clone());
                });
                let levels: Vec<&Level> = levels.into_iter().flatten().collect();
                let given: Vec<&str> = levels.iter().map(|level| level.name.as_str()).collect();
                let name = given.join(" + ");
                let scene = scene(base, &name, &levels, study)?;
                let predicted = Prediction::Within;
                let scene = scene.to_string();
                cases.push(Case { name, levels: names, predicted, reason: None, scene, finer: None });
            }
        }
        for Single { level, predicted, reason, finer } in &self.singles {
            let mut scene = scene(base, &level.name, &[level], study)?;
            let text = scene.to_string();
            let finer = match finer {
                true => {
                    patch::refine(&mut scene).map_err(|why| wrong(study, level, &level.name, &why))?;
                    Some(scene.to_string())
                }
                false => None,
            };
            let (name, levels) = (level.name.clone(), Default::default());
            let (predicted, reason) = (*predicted, reason.clone());
            cases.push(Case { name, levels, predicted, reason, scene: text, finer });
        }
        let mut names = HashSet::new();
        match cases.iter().find(|case| !names.insert(case.name.as_str())) {
            Some(twice) => {
                // Single cases have the name of their level; one of them it must be, since levels differ.
                let single = self.singles.iter().find(|single| single.level.name == twice.name);
                let why = "two cases have this name";
                Err(single.map_or_else(
                    || study.unplaced(format_args!("{}: {why}", twice.name)),
                    |single| wrong(study, &single.level, &twice.name, why),
                ))
            }
            None => Ok(cases),
        }
    }

    /// One place for each factor; 0 for one without levels.
    fn design(&self) -> Vec<Vec<usize>> {
        let counts = self.factors.each_ref().map(|levels| levels.len().max(1));
        let allowed = |places: &[usize]| {
            let levels = self.levels(places);
            let has = |name: &str| levels.iter().flatten().any(|level| level.name == name);
            !self.without.iter().any(|[one, two]| has(one) && has(two))
        };
        match self.full {
            true => combinations(&counts).into_iter().filter(|it| allowed(it)).collect(),
            false => covering_design(&counts, allowed),
        }
    }

    fn levels(&self, places: &[usize]) -> [Option<&Level>; 4] {
        std::array::from_fn(|factor| self.factors[factor].get(places[factor]))
    }

    /// Refuses levels of different factors that cannot be in one scene.
    fn check_conflicts(&self, study: Source) -> Result<()> {
        for (first, factor) in self.factors.iter().enumerate() {
            for (second, other) in self.factors.iter().enumerate().skip(first + 1) {
                for (one, two) in factor.iter().flat_map(|one| other.iter().map(move |two| (one, two))) {
                    let left_out =
                        self.without.iter().any(|it| it.contains(&one.name) && it.contains(&two.name));
                    let Some([key, rival]) = one.patch.conflict(&two.patch).filter(|_| !left_out) else {
                        continue;
                    };
                    let [a, b] = [first, second].map(|factor| FACTORS[factor]);
                    let place = two.place.clone();
                    return Err(study.error(
                        place,
                        format_args!(
                            "the {a} {:?} sets {key} and the {b} {:?} sets {rival} otherwise; \
                         let one of them set it, or leave the pair out by [[without]]",
                            one.name, two.name
                        ),
                    ));
                }
            }
        }
        Ok(())
    }
}

/// The base scene with the patches of some levels, named.
fn scene(base: &Table, name: &str, levels: &[&Level], study: Source) -> Result<Table> {
    let mut scene = base.clone();
    scene.insert("title".into(), Value::String(name.into()));
    for level in levels {
        level.patch.apply(&mut scene).map_err(|why| wrong(study, level, name, &why))?;
    }
    if let Some(tau) = levels.iter().filter_map(|level| level.tau).reduce(f64::max) {
        let last = levels.last().expect("one of them has a time");
        patch::last_until(&mut scene, tau).map_err(|why| wrong(study, last, name, &why))?;
    }
    Ok(scene)
}

/// An error of a case, shown at the name of a level of it.
fn wrong(study: Source, level: &Level, case: &str, why: &str) -> Error {
    study.error(level.place.clone(), format_args!("{case}: {why}"))
}
