//! A universality study: laws, modes and media of which each is to wear to the same limit, and cases that are not.
//!
//! ```toml
//! title = "Laws and modes"
//! scene = "../scenes/paraboloid.toml"     # or the base scene itself, as the table [scene]
//! cover = "pairs"                          # or "full"
//!
//! [tolerances]
//! within = 1e-6
//! outside = 1e-3
//!
//! [[media]]                                # four factors: media, wear, friction, modes
//! name = "k = 0.5, cone"
//! patch = { half_space = { grading = 0.5 }, indenter = { cone = { slope = 0.01 } } }
//!
//! [[modes]]
//! name = "blocks"
//! patch = { loading = { blocks = [{ tau = 2, amplitude_factor = 0.6 }] } }
//! tau = 100                                # the run lasts at least so long
//!
//! [[without]]                              # pairs that are left out
//! levels = ["blocks", "load-dependent"]
//! reason = "..."
//!
//! [[cases]]                                # single cases
//! name = "too short"
//! predicted = "outside"                    # or "within"
//! patch = { loading = { tau = 0.1 } }
//! reason = "the limit is not reached yet"
//! finer = true                             # once more with twice the springs and an eighth of the tolerance
//! ```
//!
//! A patch is laid over the base scene key by key: `loading.tau` of the patch replaces that of the base, and with it `loading.cycles`,
//! which excludes it; a law, a mode and a shape of the indenter are replaced as a whole.

mod cover;
mod reading;

pub use cover::covering_design;

use std::path::{Path, PathBuf};

use super::document::{Section, Source};
use super::{LARGEST, Rows, Scene, base_table, keys, read_text};
use crate::error::{Error, Result, most_alike};

/// Most combinations of the levels of a study, before a covering design is chosen among them.
pub const MOST_COMBINATIONS: usize = 100_000;

/// Names of the factors, in the singular.
pub const FACTORS: [&str; 4] = ["medium", "wear", "friction", "mode"];

/// Where the distance to the limit is predicted to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prediction {
    /// Within the tolerance: the case obeys universality.
    Within,
    /// Far beyond it: a negative control.
    Outside,
}

impl Prediction {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Within, Self::Outside];

    /// The word of the study: `within` or `outside`.
    pub fn name(self) -> &'static str {
        keys::PREDICTIONS[self as usize]
    }
}

/// Distances, relative to the largest depth of the predicted limit, that decide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Up to here a case obeys the limit.
    pub within: f64,
    /// From here on it violates it, above `within`.
    pub outside: f64,
}

/// One run of a study and what is predicted of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Name, different from all others.
    pub name: String,
    /// Names of its medium, wear, friction and mode, in the order of [`FACTORS`]; empty where a study does not vary one.
    pub levels: [String; 4],
    /// Where its end is to be.
    pub predicted: Prediction,
    /// Why, one sentence.
    pub reason: Option<String>,
    /// The complete scene, TOML.
    pub scene: String,
    /// The same with twice the springs and an eighth of the tolerance, where that is asked for.
    pub finer: Option<String>,
}

/// A valid study; its scenes have still to be read.
///
/// # Examples
/// ```
/// # use std::path::Path;
/// use fretwear::scene::UniversalityStudy;
///
/// let study = UniversalityStudy::read(Path::new("data/studies/universality.toml"))?;
/// let case = &study.cases()[0];
/// println!("{}: {} the limit", case.name, case.predicted.name());
/// study.scene(&case.name, &case.scene)?;
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct UniversalityStudy {
    title: Option<String>,
    tolerances: Tolerances,
    cases: Vec<Case>,
    text: String,
    name: String,
    folder: PathBuf,
}

impl UniversalityStudy {
    /// Reads a study and the base scene that it names.
    ///
    /// # Errors
    /// [`Error::Scene`], whose message shows the line with the bad place marked, or the two levels that set one key differently;
    /// [`Error::File`] if a file cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_toml(&read_text(path)?, &path.display().to_string(), folder)
    }

    /// Reads a study from its text; the base scene that it names is taken relative to a folder.
    ///
    /// # Errors
    /// As [`UniversalityStudy::read`].
    pub fn from_toml(text: &str, name: &str, folder: &Path) -> Result<Self> {
        let source = Source { name, text, kind: "a universality study" };
        if text.len() as u64 > LARGEST {
            return Err(source.unplaced(format_args!("is larger than {LARGEST} bytes, which no study is")));
        }
        let document = source.parse()?;
        let root = Section::root(source, document.get_ref());
        let values = source.values()?;
        let plan = reading::read(&root, &values)?;
        let (base, folder) = match &plan.base {
            reading::Base::Table(table) => (table.clone(), folder.to_owned()),
            reading::Base::File(file) => {
                let path = folder.join(file);
                let entry = root.required("scene", "it was read above")?;
                let text =
                    read_text(&path).map_err(|error| entry.error(format_args!("cannot be used: {error}")))?;
                (base_table(&text, &path)?, path.parent().unwrap_or(Path::new("")).to_owned())
            }
        };
        let cases = plan.cases(&base, source)?;
        let (title, tolerances) = (plan.title, plan.tolerances);
        Ok(Self { title, tolerances, cases, text: text.into(), name: name.into(), folder })
    }

    /// Title, one line.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// The distances that decide.
    pub fn tolerances(&self) -> Tolerances {
        self.tolerances
    }

    /// The cases: those of the factors in the order of their levels, then the single ones.
    pub fn cases(&self) -> &[Case] {
        &self.cases
    }

    /// The case of a name.
    ///
    /// # Errors
    /// [`Error::Scene`] names the one that is most alike.
    pub fn case(&self, name: &str) -> Result<&Case> {
        self.cases.iter().find(|case| case.name == name).ok_or_else(|| {
            let names: Vec<&str> = self.cases.iter().map(|case| case.name.as_str()).collect();
            let near = most_alike(name, &names).map_or("", |(_, near)| near);
            Error::scene(format!("{}: no case has the name {name:?}; did you mean {near:?}?", self.name))
        })
    }

    /// The TOML text of the study.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Reads the scene of a case; files that it names are relative to the base scene.
    ///
    /// # Arguments
    /// * `case` -- what messages call it
    /// * `text` -- [`Case::scene`] or [`Case::finer`]
    ///
    /// # Errors
    /// As [`Scene::from_toml`].
    pub fn scene(&self, case: &str, text: &str) -> Result<Scene> {
        Scene::with_rows(text, &format!("{}, {case}", self.name), &Rows::In(&self.folder))
    }
}
