//! Patches: what is laid over a base scene, key by key.

use toml::{Table, Value};

use super::{FINEST_ACCURACY, Numerics, Scene, keys};
use crate::error::Error;
use crate::units::Kind;

/// A value of a scene and where it stands.
#[derive(Debug, Clone, PartialEq)]
struct Setting {
    /// Table of the scene; empty for a key of the document itself.
    table: String,
    key: String,
    value: Value,
}

impl Setting {
    fn name(&self) -> String {
        if self.table.is_empty() { self.key.clone() } else { format!("{}.{}", self.table, self.key) }
    }

    /// Keys of the same table that exclude this one.
    fn rivals(&self) -> Vec<&'static str> {
        match keys::SCENE.key(&self.table).map(|key| key.kind) {
            Some(Kind::Table(table)) => table.rivals(&self.key),
            _ => vec![],
        }
    }

    /// Whether no scene can have both.
    fn excludes(&self, other: &Self) -> bool {
        let same = self.table == other.table;
        let contradicts = self.key == other.key && self.value != other.value;
        same && (contradicts || self.rivals().contains(&other.key.as_str()))
    }
}

/// Settings that are laid over a scene together.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Patch(Vec<Setting>);

impl Patch {
    pub(super) fn new(table: &Table) -> Self {
        let settings = |(name, value): (&String, &Value)| -> Vec<Setting> {
            let setting = |table: &str, key: &String, value: &Value| Setting {
                table: table.into(),
                key: key.clone(),
                value: value.clone(),
            };
            match value {
                Value::Table(inner) => inner.iter().map(|(key, value)| setting(name, key, value)).collect(),
                value => vec![setting("", name, value)],
            }
        };
        Self(table.iter().flat_map(settings).collect())
    }

    /// Names of a setting of each that exclude each other; of one patch, if `other` is the same.
    pub(super) fn conflict(&self, other: &Self) -> Option<[String; 2]> {
        let both = self.0.iter().flat_map(|one| other.0.iter().map(move |two| (one, two)));
        both.into_iter().find(|(one, two)| one.excludes(two)).map(|(one, two)| [one.name(), two.name()])
    }

    /// Lays the patch over a scene. A setting replaces the value of its key as a whole, and those that exclude it.
    ///
    /// # Errors
    /// The name of what should be a table of the scene and is none.
    pub(super) fn apply(&self, scene: &mut Table) -> Result<(), String> {
        for setting in &self.0 {
            let table = match setting.table.as_str() {
                "" => &mut *scene,
                name => table_of(scene, name)?,
            };
            setting.rivals().into_iter().for_each(|rival| {
                table.remove(rival);
            });
            table.insert(setting.key.clone(), setting.value.clone());
        }
        Ok(())
    }
}

/// Makes a scene last at least until the dimensionless time `tau`.
///
/// # Errors
/// As [`Patch::apply`].
pub(super) fn last_until(scene: &mut Table, tau: f64) -> Result<(), String> {
    let loading = table_of(scene, "loading")?;
    let own = loading.get("tau").and_then(float).unwrap_or(0.0);
    keys::LOADING.rivals("tau").into_iter().for_each(|rival| {
        loading.remove(rival);
    });
    loading.insert("tau".into(), Value::Float(own.max(tau)));
    Ok(())
}

/// Doubles the springs of a scene and divides its tolerance by 8, whichever way they are given: the error falls with the third power
/// of the number of springs, so that an eighth of the accuracy asks for twice as many.
///
/// # Errors
/// As [`Patch::apply`].
pub(super) fn refine(scene: &mut Table) -> Result<(), String> {
    let numerics = table_of(scene, "numerics")?;
    let accuracy = numerics.get("accuracy").and_then(float).unwrap_or(Numerics::default().accuracy);
    numerics.insert("accuracy".into(), Value::Float((accuracy / 8.0).max(FINEST_ACCURACY)));
    if let Some(springs) = numerics.get("springs").and_then(Value::as_integer) {
        numerics.insert("springs".into(), Value::Integer(springs.saturating_mul(2)));
    }
    if let Some(tolerance) = numerics.get("tolerance").and_then(float) {
        numerics.insert("tolerance".into(), Value::Float(tolerance / 8.0));
    }
    Ok(())
}

impl Scene {
    /// The same scene with another table `[numerics]`, and the keys of a patch laid over the others.
    ///
    /// # Arguments
    /// * `numerics` -- the whole table, TOML without its header
    /// * `patch` -- tables of a scene, TOML; a key replaces that of its name and those that exclude it
    ///
    /// # Errors
    /// [`Error::Scene`] if the result is no scene, [`Error::Inconsistent`] if one of the two is no TOML.
    pub fn varied(&self, numerics: &str, patch: &str) -> Result<Self, Error> {
        let wrong = |why: String| Error::Inconsistent { what: "variant of a scene", why };
        let read = |text: &str| text.parse::<Table>().map_err(|error| wrong(error.to_string()));
        let mut scene = read(self.text())?;
        Patch::new(&read(patch)?).apply(&mut scene).map_err(wrong)?;
        scene.insert("numerics".into(), Value::Table(read(numerics)?));
        let name = "variant of the scene";
        Self::from_stored(&scene.to_string(), name, self.table(), self.path())
    }
}

/// An inner table of a scene, which is made where there is none.
///
/// # Errors
/// Its name where that is of something else.
pub(super) fn table_of<'a>(scene: &'a mut Table, name: &str) -> Result<&'a mut Table, String> {
    let table = scene.entry(name).or_insert_with(|| Value::Table(Table::new()));
    table.as_table_mut().ok_or_else(|| format!("{name} is no table in the base scene"))
}

fn float(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|it| it as f64))
}
