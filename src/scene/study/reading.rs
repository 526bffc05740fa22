//! The tables of a study: axes, samples and what is kept.

use std::path::PathBuf;

use toml::{Table, Value};

use super::{Axis, KeptSnapshots, Sampling, Study, Task, Variable, with_unit};
use crate::error::Result;
use crate::scene::document::{Entry, Section};
use crate::scene::keys::{self, MOST_SCENES};
use crate::scene::sampling::{Distribution, Method, UnitCube};
use crate::scene::spacing::Spacing;
use crate::units::{Dimension, Unit, split_number};

/// Reads the document of a study; the base scene is added by whoever calls.
pub(super) fn read(root: &Section) -> Result<Study> {
    root.check(&keys::STUDY)?;
    let title = root.read_optional(&keys::TITLE)?;
    let task = Task::ALL[root.read::<usize>(&keys::TASK)?];
    let mut taken = Taken::default();
    let mut axes = vec![];
    if let Some(entry) = root.optional("axes") {
        for entry in entry.array(100)? {
            axes.push(axis(&entry.section()?, &mut taken)?);
        }
    }
    let sampling = match root.optional("sampling") {
        Some(entry) => Some(sampling(&entry.section()?, &mut taken)?),
        None => None,
    };
    let lengths = axes.iter().map(|axis| axis.rows.len() as u64).chain(sampling.as_ref().map(|it| it.count));
    let count = lengths.fold(1u64, u64::saturating_mul);
    if count > MOST_SCENES {
        let varied =
            root.optional("axes").or(root.optional("sampling")).expect("without either there is one scene");
        return Err(varied.misplaced(format_args!(
            "expands to {} scenes, more than {MOST_SCENES}; make the axes shorter or split the study",
            if count == u64::MAX { "too many".into() } else { count.to_string() }
        )));
    }
    let mut snapshots = KeptSnapshots::None;
    if let Some(entry) = root.optional("output") {
        let section = entry.section()?;
        section.check(&keys::KEPT)?;
        if let Some(entry) = section.optional("snapshots") {
            snapshots = kept_snapshots(&entry, count)?;
        }
    }
    Ok(Study {
        title,
        task,
        snapshots,
        base: Table::new(),
        folder: PathBuf::new(),
        name: String::new(),
        axes,
        sampling,
        count,
        text: String::new(),
        base_text: String::new(),
    })
}

fn kept_snapshots(entry: &Entry, count: u64) -> Result<KeptSnapshots> {
    if entry.is_array() {
        let last = (count - 1) as usize;
        let scenes =
            entry.array(keys::MOST_KEPT)?.iter().map(|it| it.whole(0..=last)).collect::<Result<Vec<_>>>()?;
        let mut scenes: Vec<u64> = scenes.into_iter().map(|it| it as u64).collect();
        scenes.sort_unstable();
        scenes.dedup();
        return Ok(KeptSnapshots::Of(scenes));
    }
    Ok([KeptSnapshots::None, KeptSnapshots::All][entry.word(&["none", "all"])?].clone())
}

/// The keys that vary, each once.
#[derive(Default)]
struct Taken(Vec<String>);

impl Taken {
    /// A dotted key of the scene.
    fn take(&mut self, entry: &Entry) -> Result<String> {
        let key = entry.string()?;
        if let Err(cure) = keys::find(key) {
            return Err(entry.error(format_args!("is not a key of a scene; {cure}")));
        }
        match self.0.iter().find(|other| *other == key || keys::exclude(other, key)) {
            Some(other) if other == key => Err(entry.error("is varied twice; name it in one axis only")),
            Some(other) => {
                Err(entry.error(format_args!("and {other} exclude each other; vary one of the two")))
            }
            None => {
                self.0.push(key.into());
                Ok(key.into())
            }
        }
    }
}

const MOST_ROWS: usize = MOST_SCENES as usize;

fn axis(section: &Section, taken: &mut Taken) -> Result<Axis> {
    section.check(&keys::AXIS)?;
    if let Some(entry) = section.optional("keys") {
        let keys = entry.array(100)?.iter().map(|it| taken.take(it)).collect::<Result<Vec<_>>>()?;
        let width = keys.len();
        let row = |row: &Entry| -> Result<Vec<Value>> {
            let values = row.array(width)?.iter().map(value).collect::<Result<Vec<_>>>()?;
            match values.len() == width {
                true => Ok(values),
                false => Err(row.error(format_args!("has {} values for {width} keys", values.len()))),
            }
        };
        let rows = not_empty(&section.required_key(&keys::ROWS)?)?;
        return Ok(Axis { keys, rows: rows.iter().map(row).collect::<Result<_>>()? });
    }
    let keys = vec![taken.take(&section.required_key(&keys::KEY)?)?];
    if let Some(entry) = section.optional("values") {
        let rows = not_empty(&entry)?.iter().map(|it| Ok(vec![value(it)?])).collect::<Result<_>>()?;
        return Ok(Axis { keys, rows });
    }
    let (from, to) = (section.required_key(&keys::FROM)?, section.required_key(&keys::TO)?);
    let ((low, unit), (high, other)) = (magnitude(&from)?, magnitude(&to)?);
    if unit != other {
        return Err(to.error(format_args!("has not the unit of {}, {unit:?}", from.path())));
    }
    let count = section.read(&keys::COUNT)?;
    let spacing = Spacing::ALL[section.read::<usize>(&keys::SPACING)?];
    if spacing == Spacing::Geometric && !(low > 0.0 && high > 0.0) {
        return Err(from.error(format_args!("and {} must be above zero for geometric spacing", to.path())));
    }
    let values = spacing.values(low, high, count).into_iter();
    Ok(Axis { keys, rows: values.map(|value| vec![with_unit(value, &unit)]).collect() })
}

fn not_empty<'a>(entry: &Entry<'a>) -> Result<Vec<Entry<'a>>> {
    let entries = entry.array(MOST_ROWS)?;
    match entries.is_empty() {
        true => Err(entry.error("is empty; give at least one value")),
        false => Ok(entries),
    }
}

/// A value as TOML.
fn value(entry: &Entry) -> Result<Value> {
    let value = entry.literal()?;
    match value {
        Value::Table(_) => Err(entry.error("is a table; vary its keys one by one")),
        value => Ok(value),
    }
}

/// A number and its unit, empty for a plain number.
fn magnitude(entry: &Entry) -> Result<(f64, String)> {
    let Ok(text) = entry.string() else { return Ok((entry.quantity(Dimension::NUMBER)?, String::new())) };
    let unreadable = || entry.error("is not a number with a unit such as \"5 mm\"");
    let (digits, exponent, unit) = split_number(text.trim()).ok_or_else(unreadable)?;
    let unit = unit.trim();
    Unit::read(unit).map_err(|why| entry.error(format_args!(": {why}")))?;
    let number: f64 = format!("{digits}e{exponent}").parse().map_err(|_| unreadable())?;
    match number.is_finite() {
        true => Ok((number, unit.into())),
        false => Err(entry.error("is too large for a double")),
    }
}

fn sampling(section: &Section, taken: &mut Taken) -> Result<Sampling> {
    section.check(&keys::SAMPLING)?;
    let count = section.read::<usize>(&keys::SAMPLES)? as u64;
    let method = Method::ALL[section.read::<usize>(&keys::METHOD)?];
    let seed = section.read::<usize>(&keys::SEED)? as u64;
    let entry = section.required_key(&keys::VARIABLES)?;
    let entries = entry.array(UnitCube::MOST_VARIABLES)?;
    if entries.is_empty() {
        return Err(entry.error("is empty; give at least one variable"));
    }
    let variables = entries.iter().map(|it| variable(&it.section()?, taken)).collect::<Result<Vec<_>>>()?;
    Ok(Sampling { count, cube: UnitCube::new(method, count, variables.len(), seed), variables })
}

fn variable(section: &Section, taken: &mut Taken) -> Result<Variable> {
    section.check(&keys::VARIABLE)?;
    let kind = section.read::<usize>(&keys::DISTRIBUTION)?;
    let parameters = keys::DISTRIBUTIONS[kind].1.needs;
    let key = taken.take(&section.required_key(&keys::KEY)?)?;
    let [first, second] = [section.required(parameters[0], "")?, section.required(parameters[1], "")?];
    let (one, unit) = magnitude(&first)?;
    let same_unit = |entry: &Entry| -> Result<f64> {
        let (number, other) = magnitude(entry)?;
        match other == unit {
            true => Ok(number),
            false => Err(entry.error(format_args!("has not the unit of {}, {unit:?}", first.path()))),
        }
    };
    let positive = |entry: &Entry, value: f64| match value > 0.0 {
        true => Ok(value),
        false => Err(entry.error("must be above zero")),
    };
    let mut limits = [f64::NEG_INFINITY, f64::INFINITY];
    for (limit, name) in limits.iter_mut().zip(["minimum", "maximum"]) {
        if let Some(entry) = section.optional(name) {
            *limit = same_unit(&entry)?;
        }
    }
    if limits[0] >= limits[1] {
        return Err(section.error("minimum is not below maximum"));
    }
    let distribution = match kind {
        0 | 1 => {
            let two = same_unit(&second)?;
            if one >= two {
                return Err(second.error(format_args!("is not above {} = {one}", first.path())));
            }
            match kind {
                0 => Distribution::Uniform { from: one, to: two },
                _ => Distribution::LogUniform { from: positive(&first, one)?, to: two },
            }
        }
        2 => {
            let deviation = same_unit(&second)?;
            Distribution::Normal { mean: one, deviation: positive(&second, deviation)?, bounds: limits }
        }
        _ => {
            let factor = section.read(&keys::FACTOR)?;
            limits[0] = limits[0].max(0.0);
            Distribution::LogNormal { median: positive(&first, one)?, factor, bounds: limits }
        }
    };
    Ok(Variable { key, distribution, unit })
}
