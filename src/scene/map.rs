//! The file of `fretwear map`: what to compare, over which gradings and amplitudes.

use std::path::Path;

use super::document::{Entry, Section, Source};
use super::keys::{self, MOST_ALONG_AXIS};
use super::reading::Read;
use super::sections;
use super::spacing::Spacing;
use super::{LARGEST, read_text};
use crate::contact::half_space::{HalfSpace, Poisson};
use crate::error::Result;
use crate::units::{Key, Kind};

/// Most points of a map.
pub const MOST_POINTS: usize = 10_000_000;

/// A valid description of wear maps.
///
/// # Examples
/// ```
/// use fretwear::scene::MapScene;
///
/// let scene = MapScene::from_toml("[map]\ngrading = { from = -0.5, to = 0.5, count = 11 }", "map.toml")?;
/// assert_eq!((scene.exponent, scene.gradings.len(), scene.gradings[5]), (2.0, 11, 0.0));
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MapScene {
    /// Title, one line.
    pub title: Option<String>,
    /// Exponent `n` of the indenter `f = A r^n`.
    pub exponent: f64,
    /// Poisson's ratio of all half-spaces, or elastic similarity.
    pub poisson: Poisson,
    /// Gradings of the map, increasing, each in (-1, 1).
    pub gradings: Vec<f64>,
    /// Amplitudes `U/(μ_f d)` of the map, increasing, each positive.
    pub amplitude_ratios: Vec<f64>,
    /// Values `ΔV(k)/ΔV(0)` of the isolines, increasing, each positive.
    pub levels: Vec<f64>,
    /// Amplitudes `U/(μ_f d)` at which the optimal grading is searched, increasing.
    pub optimum_amplitude_ratios: Vec<f64>,
    /// Depths of reference `z0`, in contact radii of the homogeneous contact, for the optimum at fixed force.
    pub reference_depths: Vec<f64>,
    /// Gradings of the worn profiles.
    pub profile_gradings: Vec<f64>,
    /// Amplitude `U/(μ_f d)` of the worn profiles.
    pub profile_amplitude_ratio: f64,
    /// Number of radii of the worn profiles, at least 2.
    pub profile_points: usize,
    /// The TOML text as it was read.
    pub text: String,
}

impl Default for MapScene {
    /// The paraboloid under elastic similarity, as in the paper.
    fn default() -> Self {
        Self::from_toml("", "the built-in map").expect("an empty file is valid")
    }
}

impl MapScene {
    /// Reads the TOML text.
    ///
    /// # Errors
    /// As [`Scene::from_toml`](super::Scene::from_toml).
    pub fn from_toml(text: &str, name: &str) -> Result<Self> {
        let source = Source { name, text, kind: "a map" };
        if text.len() as u64 > LARGEST {
            return Err(source.unplaced(format_args!("is larger than {LARGEST} bytes, which no map is")));
        }
        let document = source.parse()?;
        map(&Section::root(source, document.get_ref()), text)
    }

    /// Reads the file.
    ///
    /// # Errors
    /// As [`Scene::from_path`](super::Scene::from_path).
    pub fn read(path: &Path) -> Result<Self> {
        Self::from_toml(&read_text(path)?, &path.display().to_string())
    }
}

fn map(root: &Section, text: &str) -> Result<MapScene> {
    root.check(&keys::MAP)?;
    let title = root.read_optional(&keys::TITLE)?;
    let table = |key: &str| -> Result<Option<Section>> {
        let Some(entry) = root.optional(key) else { return Ok(None) };
        let section = entry.section()?;
        match keys::MAP.key(key).map(|it| it.kind) {
            Some(Kind::Table(table)) => section.check(table).map(|()| Some(section)),
            _ => unreachable!("{key} is a table of a map"),
        }
    };

    let mut exponent = 2.0;
    if let Some(indenter) = table("indenter")? {
        exponent = indenter.read(&keys::MAP_EXPONENT)?;
    }
    let mut poisson = Poisson::Similar;
    if let Some(half_space) = table("half_space")? {
        poisson = sections::poisson(&half_space)?;
        HalfSpace::from_modulus(0.0, 1.0, 1.0, poisson).map_err(|error| half_space.locate(error))?;
    }

    let mut gradings: Vec<f64> = (0..190).map(|i| (i as f64 - 90.0) / 100.0).collect();
    let mut amplitude_ratios: Vec<f64> = Spacing::Geometric.values(1e-4, 1.0, 161);
    let mut levels =
        vec![0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0];
    if let Some(section) = table("map")? {
        replace(&mut gradings, &section, &keys::MAP_GRADINGS)?;
        replace(&mut amplitude_ratios, &section, &keys::MAP_AMPLITUDES)?;
        replace(&mut levels, &section, &keys::LEVELS)?;
        bounded(&section, gradings.len(), amplitude_ratios.len())?;
    }
    let mut optimum_amplitude_ratios = Spacing::Geometric.values(1e-6, 1.4, 124);
    let mut reference_depths = vec![1.0];
    if let Some(section) = table("optimum")? {
        replace(&mut optimum_amplitude_ratios, &section, &keys::OPTIMUM_AMPLITUDES)?;
        replace(&mut reference_depths, &section, &keys::REFERENCE_DEPTHS)?;
    }
    let mut profile_gradings = vec![-0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 0.9];
    let (mut profile_amplitude_ratio, mut profile_points) = (0.5, 401);
    if let Some(section) = table("profiles")? {
        replace(&mut profile_gradings, &section, &keys::MAP_GRADINGS)?;
        profile_amplitude_ratio = section.read(&keys::PROFILE_AMPLITUDE)?;
        profile_points = section.read(&keys::PROFILE_POINTS)?;
        bounded(&section, profile_gradings.len(), profile_points)?;
    }
    Ok(MapScene {
        title,
        exponent,
        poisson,
        gradings,
        amplitude_ratios,
        levels,
        optimum_amplitude_ratios,
        reference_depths,
        profile_gradings,
        profile_amplitude_ratio,
        profile_points,
        text: text.into(),
    })
}

fn bounded(section: &Section, rows: usize, columns: usize) -> Result<()> {
    if rows * columns <= MOST_POINTS {
        return Ok(());
    }
    Err(section
        .error(format_args!("{rows} x {columns} points are more than {MOST_POINTS}; make the steps coarser")))
}

fn replace(values: &mut Vec<f64>, section: &Section, key: &Key) -> Result<()> {
    let (Some(entry), Kind::Axis(item, _)) = (section.optional(key.name), key.kind) else { return Ok(()) };
    *values = axis_values(&entry, item)?;
    Ok(())
}

/// A list of values, in any order, or `{ from, to, count, spacing }`.
fn axis_values(entry: &Entry, item: &Key) -> Result<Vec<f64>> {
    let number = |entry: &Entry| f64::read(entry, item);
    if !entry.is_table() {
        let entries = entry.array(MOST_ALONG_AXIS)?;
        if entries.is_empty() {
            return Err(entry.error("is empty; give at least one value"));
        }
        let mut values = entries.iter().map(number).collect::<Result<Vec<_>>>()?;
        values.sort_by(f64::total_cmp);
        values.dedup();
        return Ok(values);
    }
    let section = entry.section()?;
    section.check(&keys::STEPS)?;
    let [from, to] = [section.required_key(&keys::FIRST)?, section.required_key(&keys::LAST)?];
    let (low, high) = (number(&from)?, number(&to)?);
    if low >= high {
        return Err(to.error(format_args!("is not above {} = {low}", from.path())));
    }
    // Values that are never negative are spread in equal ratios.
    let positive = item.range.from.0 >= 0.0;
    let spacing = match section.read_optional::<usize>(&keys::SPACING)? {
        Some(place) => Spacing::ALL[place],
        None if positive => Spacing::Geometric,
        None => Spacing::Linear,
    };
    if spacing == Spacing::Geometric && low <= 0.0 {
        return Err(section.required_key(&keys::SPACING)?.error("needs values above zero; use \"linear\""));
    }
    Ok(spacing.values(low, high, section.read(&keys::MAP_COUNT)?))
}
