//! Results for other programs: any table of a file as CSV, and the worn surface for ParaView.

use std::f64::consts::TAU;

use crate::data::{ResultPath, RunFile, SurfaceSeries};
use crate::error::{Error, Result};
use crate::scene::Scene;

/// Most points of a surface over all times: some 50 bytes each.
const MOST_POINTS: usize = 20_000_000;

/// Circles drawn within the first node of a run, where nothing wears; the axis is not among them.
const INNER_CIRCLES: usize = 12;

/// The surface of revolution of a run at all its snapshots, at true scale: the axis is z, the tip of the unworn profile is the origin, the time
/// is that of the cycles.
///
/// Values at the points are `wear_depth` and `slip`, m, and `pressure`, Pa. Within the first node, where nothing wears, the profile is that of
/// the indenter of the scene, and pressure is not a number.
///
/// # Arguments
/// * `file` -- that of the run
/// * `sectors` -- points around the axis, at least 3
///
/// # Errors
/// [`Error::File`] if the file cannot be read or would make a surface of more than twenty million points, [`Error::Scene`] if its scene cannot be
/// read.
///
/// # Panics
/// For fewer than 3 sectors.
pub fn worn_surface<'a>(file: impl Into<ResultPath<'a>>, sectors: usize) -> Result<SurfaceSeries> {
    assert!(sectors >= 3, "{sectors} sectors");
    let file = file.into();
    let (run, path) = (RunFile::open(file)?, file.path());
    let header = &run.header;
    let name = path.display().to_string();
    let scene = Scene::from_stored(&header.scene, &name, header.table.clone(), header.path.clone())?;
    let circles = INNER_CIRCLES + header.radius.len();
    let points = run.snapshots.len().saturating_mul(1 + circles * sectors);
    if points > MOST_POINTS {
        return Err(Error::File {
            path: path.to_owned(),
            why: format!(
                "its {} snapshots of {circles} circles make {points} points, more than {MOST_POINTS}; ask for fewer snapshots in the scene",
                run.snapshots.len()
            ),
        });
    }
    let inner =
        (0..=INNER_CIRCLES).map(|circle| header.radius[0] * circle as f64 / (INNER_CIRCLES + 1) as f64);
    let radius: Vec<f64> = inner.clone().chain(header.radius.iter().copied()).collect();
    let unworn: Vec<f64> = inner.map(|r| scene.indenter().profile(r)).collect();
    // Along the radius, the axis first.
    let curve = |within: f64, outside: &[f64]| -> Vec<f64> {
        std::iter::repeat_n(within, 1 + INNER_CIRCLES).chain(outside.iter().copied()).collect()
    };
    let mut series = SurfaceSeries::default();
    (series.connectivity, series.offsets) = polygons(circles, sectors);
    let (mut depths, mut slips, mut pressures) = (vec![], vec![], vec![]);
    for snapshot in &run.snapshots {
        series.times.push(snapshot.cycles);
        let height: Vec<f64> = unworn.iter().chain(&snapshot.profile).copied().collect();
        for (place, (r, z)) in radius.iter().zip(&height).enumerate() {
            let around = if place == 0 { 1 } else { sectors };
            series.points.extend((0..around).flat_map(|sector| {
                let angle = TAU * sector as f64 / sectors as f64;
                [r * angle.cos(), r * angle.sin(), *z]
            }));
        }
        depths.extend(revolved(&curve(0.0, &snapshot.wear_depth), sectors));
        slips.extend(revolved(&curve(0.0, &snapshot.slip), sectors));
        pressures.extend(revolved(&curve(f64::NAN, &snapshot.pressure), sectors));
    }
    series.values = vec![("wear_depth", depths), ("slip", slips), ("pressure", pressures)];
    Ok(series)
}

/// Values along the radius at all points: once at the axis, then all the way round each circle.
fn revolved(curve: &[f64], sectors: usize) -> impl Iterator<Item = f64> {
    let around = move |(place, value): (usize, &f64)| {
        std::iter::repeat_n(*value, if place == 0 { 1 } else { sectors })
    };
    curve.iter().enumerate().flat_map(around)
}

/// Triangles around the axis and quadrilaterals between the circles, and where each begins.
fn polygons(circles: usize, sectors: usize) -> (Vec<i64>, Vec<i64>) {
    let point = |circle: usize, sector: usize| (1 + circle * sectors + sector % sectors) as i64;
    let (mut connectivity, mut offsets) = (vec![], vec![0]);
    for sector in 0..sectors {
        connectivity.extend([0, point(0, sector), point(0, sector + 1)]);
        offsets.push(connectivity.len() as i64);
    }
    for circle in 1..circles {
        for sector in 0..sectors {
            let [inside, outside] = [circle - 1, circle];
            connectivity.extend([
                point(inside, sector),
                point(outside, sector),
                point(outside, sector + 1),
                point(inside, sector + 1),
            ]);
            offsets.push(connectivity.len() as i64);
        }
    }
    (connectivity, offsets)
}
