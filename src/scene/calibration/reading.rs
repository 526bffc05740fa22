//! The tables of a calibration.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::measurements::{Column, Measurements};
use super::{Calibration, DataSet, Deviation, Measured, Model, Unknown};
use crate::error::Result;
use crate::scene::document::{Entry, Section};
use crate::scene::keys;
use crate::scene::reading::Read;
use crate::scene::settings::check;
use crate::units::{Dimension, Form, Key, Kind, Range, Unit, split_number};

/// Keys that follow from the data.
const OF_DATA: [&str; 4] = ["loading.cycles", "loading.tau", "loading.until_rate", "output."];

/// Reads the document and the measurements; the base scene is added by whoever calls.
pub(super) fn read(root: &Section, values: &Table, folder: &Path) -> Result<Calibration> {
    root.check(&keys::CALIBRATION)?;
    let title = root.read_optional(&keys::TITLE)?;
    let is_robust = root.read::<usize>(&keys::LOSS)? == 1;
    let (bootstrap, seed) =
        (root.read::<usize>(&keys::BOOTSTRAP)? as u64, root.read::<usize>(&keys::SEED)? as u64);
    let compares = root.optional("models").is_some();
    let mut taken = vec![];
    let unknowns = match root.optional("unknowns") {
        None if compares => vec![],
        _ => unknowns(not_empty(root, "unknowns", keys::MOST_UNKNOWNS)?, &mut taken)?,
    };
    let models = if compares { models(root, values, &mut taken)? } else { vec![] };
    let (mut data, mut notes) = (vec![], vec![]);
    let sections = not_empty(root, "data", keys::MOST_DATA)?;
    let sections = sections.iter().map(Entry::section).collect::<Result<Vec<_>>>()?;
    for (place, section) in sections.iter().enumerate() {
        let own = values.get("data").and_then(|it| it.get(place)?.get("set")?.as_table());
        let settings = settings(section, own, &taken)?;
        data.push(data_set(section, folder, settings, &mut notes)?);
    }
    if root.optional("scene").is_none() {
        let needs = data.iter().position(|it| it.measured != Measured::VolumeOverEnergy);
        if let Some(place) = needs {
            let what = data[place].measured.name();
            return Err(sections[place].error(format_args!(
                "data[{place}] is a {what}, which needs the scene of the test; give scene = \"FILE.toml\""
            )));
        }
        let is_alpha = |it: &Unknown| it.key == super::ALPHA && it.tied.is_empty();
        if compares || unknowns.len() != 1 || !is_alpha(&unknowns[0]) {
            return Err(root.error(format_args!(
                "without a scene the one unknown is {}, the worn volume over the dissipated energy",
                super::ALPHA
            )));
        }
    }
    Ok(Calibration {
        title,
        unknowns,
        data,
        settings: vec![],
        models,
        is_robust,
        bootstrap,
        seed,
        base: None,
        folder: PathBuf::new(),
        name: String::new(),
        text: String::new(),
        base_text: String::new(),
        notes,
    })
}

fn unknowns(entries: Vec<Entry>, taken: &mut Vec<String>) -> Result<Vec<Unknown>> {
    entries.iter().map(|entry| unknown(&entry.section()?, taken)).collect()
}

/// The laws that are compared; all their unknowns are added to those that are taken.
fn models(root: &Section, values: &Table, taken: &mut Vec<String>) -> Result<Vec<Model>> {
    let (common, mut found) = (taken.clone(), Vec::<Model>::new());
    for (place, entry) in not_empty(root, "models", keys::MOST_MODELS)?.iter().enumerate() {
        let section = entry.section()?;
        section.check(&keys::MODEL)?;
        let name = section.required("name", "name the law")?;
        let title = String::read(&name, &keys::NAME)?;
        if title.trim().is_empty() || found.iter().any(|it| it.name == title) {
            return Err(name.error("is empty or given twice; names must differ"));
        }
        let mut own = common.clone();
        let entries = section.optional("unknowns").map(|it| it.array(keys::MOST_UNKNOWNS)).transpose()?;
        let unknowns = unknowns(entries.unwrap_or_default(), &mut own)?;
        if own.is_empty() || own.len() > keys::MOST_UNKNOWNS {
            let most = keys::MOST_UNKNOWNS;
            return Err(section.error(format_args!("{title} has {} unknowns; give 1 to {most}", own.len())));
        }
        let set = values.get("models").and_then(|it| it.get(place)?.get("set")?.as_table());
        let settings = settings(&section, set, &own)?;
        taken.extend(own.into_iter().filter(|key| !common.contains(key)));
        found.push(Model { name: title, settings, unknowns });
    }
    Ok(found)
}

fn not_empty<'a>(root: &Section<'a>, name: &str, most: usize) -> Result<Vec<Entry<'a>>> {
    let key = keys::CALIBRATION.key(name).expect("it is declared");
    let entry = root.required_key(key)?;
    let entries = entry.array(most)?;
    match entries.is_empty() {
        true => Err(entry.misplaced(format_args!("is empty; add {}", key.example))),
        false => Ok(entries),
    }
}

/// A dotted key of the scene that may be varied, each once.
fn take(entry: &Entry, taken: &mut Vec<String>) -> Result<&'static Key> {
    let key = entry.string()?;
    let declared =
        keys::find(key).map_err(|cure| entry.error(format_args!("is not a key of a scene; {cure}")))?;
    if OF_DATA.iter().any(|own| key.starts_with(own)) || key.starts_with("numerics.") {
        return Err(entry.error("follows from the data; name a key of the physics"));
    }
    if !matches!(declared.kind, Kind::Quantity(_) | Kind::Scaled | Kind::NumberOr(_)) {
        return Err(entry.error("is not a key of a number; what can be found is a number"));
    }
    match taken.iter().find(|other| *other == key || keys::exclude(other, key)) {
        Some(other) if other == key => return Err(entry.error("is named twice; name it once")),
        Some(other) => {
            return Err(entry.error(format_args!("and {other} exclude each other; find one of the two")));
        }
        None => taken.push(key.into()),
    }
    Ok(declared)
}

fn unknown(section: &Section, taken: &mut Vec<String>) -> Result<Unknown> {
    section.check(&keys::UNKNOWN)?;
    let entry = section.required("key", "name the key of the scene that is found")?;
    let declared = take(&entry, taken)?;
    let mut tied = vec![];
    if let Some(list) = section.optional("tied") {
        for entry in list.array(100)? {
            if take(&entry, taken)?.si_unit() != declared.si_unit() {
                return Err(entry.error(format_args!("has not the unit of {}", declared.name)));
            }
            tied.push(entry.string()?.to_owned());
        }
    }
    let bound = |name: &str| -> Result<f64> {
        let entry = section.required(name, "give the values between which it is looked for")?;
        let value = match (declared.kind, entry.string()) {
            (Kind::Quantity(dimension), _) => entry.quantity(dimension)?,
            (_, Err(_)) => entry.quantity(Dimension::NUMBER)?,
            (_, Ok(text)) => in_si(text).ok_or_else(|| entry.error("is not a number with a unit"))?,
        };
        match declared.range.contains(value) {
            true => Ok(value),
            false => Err(entry.outside(&declared.range_in_words())),
        }
    };
    let bounds = [bound("from")?, bound("to")?];
    if bounds[0] >= bounds[1] {
        return Err(section.at_key("to", format_args!(" is not above {}", section.name("from"))));
    }
    let scale = section.read_optional::<usize>(&keys::SCALE)?;
    let is_logarithmic = scale.map_or(bounds[0] > 0.0, |scale| scale == 0);
    if is_logarithmic && bounds[0] <= 0.0 {
        return Err(section.at_key("from", " must be above 0 for scale = \"log\""));
    }
    Ok(Unknown { key: entry.string()?.into(), tied, bounds, is_logarithmic, unit: declared.si_unit() })
}

/// A number with any unit, in SI.
fn in_si(text: &str) -> Option<f64> {
    let (digits, exponent, unit) = split_number(text.trim())?;
    let unit = unit.trim();
    let unit = if unit.is_empty() { Unit::ONE } else { Unit::read(unit).ok()? };
    unit.scale(digits, exponent)
}

/// Dimension of the values, and name and dimension of the column that they stand beside.
fn columns(measured: Measured) -> (&'static str, Dimension, &'static str, Dimension) {
    let volume = Dimension::LENGTH.times(Dimension::LENGTH, 2.0);
    let (number, length) = (Dimension::NUMBER, Dimension::LENGTH);
    match measured {
        Measured::WearVolume => ("wear_volume", volume, "cycles", number),
        Measured::WearDepth => ("wear_depth", length, "cycles", number),
        Measured::ContactRadius => ("contact_radius", length, "cycles", number),
        Measured::TangentialForce => ("tangential_force", Dimension::FORCE, "cycles", number),
        Measured::CycleEnergy => ("cycle_energy", Dimension::ENERGY, "cycles", number),
        Measured::DissipatedEnergy => ("dissipated_energy", Dimension::ENERGY, "cycles", number),
        Measured::VolumeOverEnergy => ("wear_volume", volume, "dissipated_energy", Dimension::ENERGY),
        Measured::Scar => ("height", length, "position", length),
        Measured::Loop => ("tangential_force", Dimension::FORCE, "displacement", length),
    }
}

fn data_set(
    section: &Section,
    folder: &Path,
    settings: Vec<(String, Value)>,
    notes: &mut Vec<String>,
) -> Result<DataSet> {
    section.check(&keys::DATA)?;
    let given = |form: &Form| form.needs.iter().all(|key| section.optional(key).is_some());
    let form = keys::FORMS_OF_DATA.iter().rposition(given).expect("it has one of the forms");
    let measured = Measured::ALL[form];
    let (value_key, dimension, beside_key, beside) = columns(measured);
    let cycles = match measured.is_over_cycles() || measured == Measured::VolumeOverEnergy {
        true => 0.0,
        false => f64::read(&section.required("cycles", "")?, &NUMBER_OF_CYCLES)?,
    };

    let file = section.required("file", "name the file of the measurements")?.string()?;
    let path = folder.join(file);
    if file.is_empty() || !path.exists() {
        let why = "there is no such file; it is taken relative to the folder of the calibration";
        return Err(section.at_key("file", format_args!(": {}: {why}", path.display())));
    }
    let filter = section.read_optional::<String>(&keys::WHERE)?;
    let table = Measurements::read(&path, filter.as_deref())?;
    let column = |key: &str| -> Result<Column> {
        let entry = section.required(key, "")?;
        table.column(entry.string()?).map_err(|why| entry.error(why))
    };
    let (first, mut second) = (column(beside_key)?, column(value_key)?);
    if let Some(entry) = section.optional("unit") {
        second = second.in_unit(entry.string()?).map_err(|why| entry.error(why))?;
    }
    let mut wanted = vec![(first, beside), (second.clone(), dimension)];
    let mut deviation = match section.optional("relative_deviation") {
        Some(entry) if entry.string().is_ok() => {
            entry.word(&["estimated"])?;
            Deviation::EstimatedRelative
        }
        Some(entry) => {
            let key = Key { kind: Kind::Quantity(Dimension::NUMBER), ..keys::RELATIVE_DEVIATION };
            Deviation::Relative(f64::read(&entry, &key)?)
        }
        None => Deviation::Estimated,
    };
    if let Some(entry) = section.optional("deviation") {
        match entry.string() {
            Ok(name) => {
                let own = table.column(name).map_err(|why| entry.error(why))?;
                let own = own.or_in_unit(second.unit.as_deref());
                wanted.push((own, dimension));
            }
            Err(_) => {
                let number = f64::read(&entry, &POSITIVE)?;
                let scale = second.scale(dimension).map_err(|why| entry.error(why))?;
                deviation = Deviation::Known(vec![number * scale]);
            }
        }
    }
    let (lines, mut columns, left_out) = table.numbers(&wanted)?;
    if left_out > 0 {
        let rows = if left_out == 1 { "row is" } else { "rows are" };
        notes.push(format!("{}: {left_out} {rows} left out, where a value is missing", path.display()));
    }
    if wanted.len() == 3 {
        deviation = Deviation::Known(columns.pop().expect("there are three"));
    } else if let Deviation::Known(all) = &mut deviation {
        *all = vec![all[0]; lines.len()];
    }
    let (values, at) = (columns.pop().expect("there are two"), columns.pop().expect("there is one left"));
    let set = DataSet {
        file: file.into(),
        measured,
        at,
        values,
        lines,
        deviation,
        cycles,
        share: section.read(&keys::SHARE)?,
        settings,
    };
    table.check(&set)?;
    Ok(set)
}

const NUMBER_OF_CYCLES: Key = Key::number("cycles", "").range(Range::POSITIVE);
const POSITIVE: Key = Key::number("deviation", "").range(Range::POSITIVE);

/// The keys of the scene for one data set: dotted names, quoted or as tables within tables.
fn settings(section: &Section, values: Option<&Table>, unknowns: &[String]) -> Result<Vec<(String, Value)>> {
    let Some(entry) = section.optional("set") else { return Ok(vec![]) };
    entry.section()?;
    let mut found = vec![];
    flatten(values.unwrap_or(&Table::new()), "", &mut found);
    for (place, (key, value)) in found.iter().enumerate() {
        let wrong = |why: String| entry.misplaced(format_args!("{key} = {value} {why}"));
        let declared =
            keys::find(key).map_err(|cure| wrong(format!("is not of a key of a scene; {cure}")))?;
        if OF_DATA.iter().any(|own| key.starts_with(own)) {
            return Err(wrong("follows from the data; leave it out".into()));
        }
        let mut others = unknowns.iter().chain(found[..place].iter().map(|(key, _)| key));
        if let Some(other) = others.find(|other| *other == key || keys::exclude(other, key)) {
            return Err(wrong(format!("and {other} exclude each other; give one of the two")));
        }
        check(key, value, declared)?;
    }
    Ok(found)
}

fn flatten(table: &Table, prefix: &str, found: &mut Vec<(String, Value)>) {
    for (key, value) in table {
        let name = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
        match value {
            Value::Table(inner) => flatten(inner, &name, found),
            value => found.push((name, value.clone())),
        }
    }
}
