//! Scenes made in memory: from a file, from text, key by key.

use std::str::FromStr;

use toml::{Table, Value};

use super::Scene;
use super::patch::table_of;
use crate::error::{Error, Result};

/// A scene that is made key by key, each by its path in the TOML of a scene.
///
/// ```
/// let scene = fretwear::Scene::builder()
///     .set("indenter.paraboloid.radius", "10 mm")
///     .set("half_space.grading", 0.0)
///     .set("half_space.modulus", 210e9)
///     .set("half_space.poisson_ratio", 0.3)
///     .set("friction.coulomb.coefficient", 0.6)
///     .set("wear.archard.coefficient", "1e-14 1/Pa")
///     .set("loading.initial_force", "50 N")
///     .set("loading.stick_ratio", 0.7)
///     .set("loading.tau", 30.0)
///     .build()?;
/// assert_eq!(scene.half_space().grading(), 0.0);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct SceneBuilder {
    document: Table,
    /// A key below one that is no table.
    misplaced: Option<String>,
}

impl SceneBuilder {
    /// Sets a key, or replaces its value.
    ///
    /// # Arguments
    /// * `key` -- its path, such as `half_space.modulus`
    /// * `value` -- a number in SI units, text with a unit such as `"210 GPa"`, a truth value, or a list of these
    #[must_use]
    pub fn set(mut self, key: &str, value: impl Into<Value>) -> Self {
        let (tables, name) = key.rsplit_once('.').unwrap_or(("", key));
        let mut table = &mut self.document;
        for part in tables.split('.').filter(|part| !part.is_empty()) {
            let Ok(inner) = table_of(table, part) else {
                self.misplaced = Some(key.to_owned());
                return self;
            };
            table = inner;
        }
        table.insert(name.to_owned(), value.into());
        self
    }

    /// The scene.
    ///
    /// # Errors
    /// As [`Scene::from_toml`]; lines are those of the TOML that the keys make.
    pub fn build(self) -> Result<Scene> {
        match self.misplaced {
            Some(key) => {
                let shown = format!("{key}: stands below a key that has a value of its own");
                Err(Error::scene(shown).about(&key))
            }
            None => Scene::from_toml(&self.document.to_string(), "scene"),
        }
    }
}

impl Scene {
    /// Begins a scene without any key.
    pub fn builder() -> SceneBuilder {
        SceneBuilder::default()
    }
}

impl FromStr for Scene {
    type Err = Error;

    /// Reads a scene from its TOML text, as [`Scene::from_toml`] does.
    fn from_str(text: &str) -> Result<Self> {
        Self::from_toml(text, "scene")
    }
}
