//! Settings: single keys of a scene in place of those that it has, as `--set` and the axes of studies give them.

use std::path::Path;

use toml::{Table, Value};

use super::document::{Section, Source};
use super::patch::table_of;
use super::{Rows, Scene, base_table, keys, read_text};
use crate::error::{Error, Result};
use crate::units::{Key, Kind};

impl Scene {
    /// Reads a scene from a file, with other values of some of its keys. What cannot stand beside a key that is set is left out: an amplitude takes
    /// the place of a stick ratio, a law that of another.
    ///
    /// # Arguments
    /// * `settings` -- each `key=value`, such as `loading.amplitude=2 um`; the value as in TOML, texts without quotes as well
    ///
    /// # Errors
    /// As [`Scene::from_path`]; also where a setting is not of a key, with the one that is nearest, or has not its dimension or range.
    pub fn read_with(path: &Path, settings: &[String]) -> Result<Self> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_toml_with(&read_text(path)?, path, folder, settings)
    }

    /// Reads a scene from its text as [`Scene::read_with`] does from a file.
    ///
    /// # Arguments
    /// * `name` -- what messages call it, the path of the file as a rule
    /// * `folder` -- that to which the files it names are relative
    ///
    /// # Errors
    /// As [`Scene::read_with`].
    pub fn from_toml_with(text: &str, name: &Path, folder: &Path, settings: &[String]) -> Result<Self> {
        let rows = Rows::In(folder);
        if settings.is_empty() {
            return Self::with_rows(text, &name.display().to_string(), &rows);
        }
        let mut scene = base_table(text, name)?;
        let mut taken: Vec<&str> = vec![];
        for setting in settings {
            let (key, value) = parsed(setting)?;
            let wrong = |why: String| outer(setting).unplaced(why);
            if let Some(other) = taken.iter().find(|other| keys::exclude(other, key)) {
                return Err(wrong(format!("{key} and {other} exclude each other; set one of the two")));
            }
            set(&mut scene, SETTING, key, value)?;
            taken.push(key);
        }
        Self::with_rows(&scene.to_string(), &Self::name_with(name, settings), &rows)
    }

    /// What messages call a scene that [`Scene::read_with`] read: lines are those of the scene with the settings.
    pub fn name_with(path: &Path, settings: &[String]) -> String {
        match settings.is_empty() {
            true => path.display().to_string(),
            false => format!("{} with {}", path.display(), settings.join(", ")),
        }
    }
}

/// What messages call a setting.
const SETTING: &str = "setting";

/// The document that messages about a setting show.
fn outer(text: &str) -> Source<'_> {
    Source { name: SETTING, text, kind: "a scene" }
}

/// Key and value of a setting, checked by themselves.
fn parsed(setting: &str) -> Result<(&str, Value)> {
    let wrong = |why: String| outer(setting).unplaced(format_args!("{setting:?} {why}"));
    let (key, value) = setting.split_once('=').ok_or_else(|| wrong("is not of the form key=value".into()))?;
    let (key, value) = (key.trim(), value.trim());
    let declared = keys::find(key).map_err(|cure| wrong(format!("is not of a key of a scene; {cure}")))?;
    let literal = |text: &str| format!("value = {text}").parse::<Table>().ok()?.remove("value");
    let value = literal(value).unwrap_or_else(|| Value::String(value.into()));
    check(key, &value, declared)?;
    Ok((key, value))
}

/// Checks the value of a dotted key by itself.
///
/// # Errors
/// [`Error::Scene`] shows it as it would stand in a scene.
pub(super) fn check(key: &str, value: &Value, declared: &Key) -> Result<()> {
    let text = format!("{key} = {value}");
    let source = outer(&text);
    let document = source.parse()?;
    let mut section = Section::root(source, document.get_ref());
    let (tables, last) = key.rsplit_once('.').unwrap_or(("", key));
    for table in tables.split('.').filter(|it| !it.is_empty()) {
        section = section.required(table, "")?.section()?;
    }
    section.required(last, "")?.check(declared)
}

/// Sets a dotted key of a scene, and leaves out what cannot stand beside it.
///
/// # Arguments
/// * `name` -- of what sets it, for messages
///
/// # Errors
/// [`Error::Scene`] names what should be a table of the scene and is none.
pub(super) fn set(scene: &mut Table, name: &str, dotted: &str, value: Value) -> Result<()> {
    let (tables, last) = dotted.rsplit_once('.').unwrap_or(("", dotted));
    let (mut table, mut declared) = (scene, &keys::SCENE);
    for part in tables.split('.').filter(|it| !it.is_empty()) {
        declared.rivals(part).into_iter().for_each(|rival| drop(table.remove(rival)));
        table = table_of(table, part)
            .map_err(|why| Error::scene(format!("{name}: {dotted}: {why}")).about(dotted))?;
        if let Some(Kind::Table(inner)) = declared.key(part).map(|key| key.kind) {
            declared = inner;
        }
    }
    declared.rivals(last).into_iter().for_each(|rival| drop(table.remove(rival)));
    table.insert(last.into(), value);
    Ok(())
}
