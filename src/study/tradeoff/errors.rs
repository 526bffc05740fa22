//! How wrong a run is: against the closed-form limit, the Gibson transient, or a finer run, whichever is known best.

use super::profile::Shape;
use crate::contact::closed_form::{GibsonTransient, LimitingShape};
use crate::data::{RunFile, SAME_CYCLES, Snapshot, same_cycles};
use crate::error::Result;
use crate::numerics::curve::distance_from_curve;
use crate::numerics::linear::largest;
use crate::scene::Scene;

/// An error is a number of its own from so many times the uncertainty of the reference on; below it is bounded.
const CLEAR: f64 = 3.0;

/// What a snapshot is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReferenceKind {
    /// Nothing: the finer run has no snapshot of that time, and the limit is far.
    None,
    /// The closed-form limit.
    Limit,
    /// The logistic transient of `k → 1`.
    Gibson,
    /// A run with more springs and smaller steps.
    Reference,
}

impl ReferenceKind {
    /// All of them; the place is the number in files.
    pub const ALL: [Self; 4] = [Self::None, Self::Limit, Self::Gibson, Self::Reference];

    /// Name in JSON: `none`, `limit`, `gibson` or `reference`.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Limit => "limit",
            Self::Gibson => "gibson",
            Self::Reference => "reference",
        }
    }
}

/// An error as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The error, or its bound: what was found and the uncertainty of the reference together.
    pub value: f64,
    /// Whether it is only a bound.
    pub bounded: bool,
}

impl Measured {
    /// From what was found against a reference of some uncertainty.
    ///
    /// ```
    /// use fretwear::study::tradeoff::Measured;
    /// assert_eq!(Measured::new(1e-3, 1e-5), Measured { value: 1e-3, bounded: false });
    /// assert_eq!(Measured::new(2e-5, 1e-5), Measured { value: 2e-5 + 1e-5, bounded: true });
    /// ```
    pub fn new(found: f64, uncertainty: f64) -> Self {
        let bounded = found < CLEAR * uncertainty;
        Self { value: if bounded { found + uncertainty } else { found }, bounded }
    }

    fn larger(self, other: Self) -> Self {
        if other.value > self.value { other } else { self }
    }
}

/// Errors of one snapshot; those of the volume are relative to the limit's volume, those of depths to the limit's largest depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Cycles of the snapshot.
    pub cycles: f64,
    /// Its dimensionless time.
    pub tau: f64,
    /// Its worn volume, m³.
    pub wear_volume: f64,
    /// That of the reference, m³.
    pub wear_volume_reference: f64,
    /// What volume and depth were compared with.
    pub sources: [ReferenceKind; 2],
    /// Uncertainty of the reference in the volume and in the depth.
    pub uncertainty: [f64; 2],
    /// Error of the worn volume.
    pub volume: Measured,
    /// Largest error of the depth on radii common to all candidates, to which it is interpolated.
    pub profile: Measured,
    /// Largest error of the depth at the radii of its own file.
    pub nodes: Measured,
}

/// The largest errors over the snapshots of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Of the worn volume.
    pub volume: Measured,
    /// Of the profile on common radii.
    pub profile: Measured,
    /// Of the profile at its own radii.
    pub nodes: Measured,
}

impl Worst {
    /// None where no snapshot could be compared.
    pub fn of(errors: &[Errors]) -> Option<Self> {
        let compared = errors.iter().filter(|it| !it.sources.contains(&ReferenceKind::None));
        compared.map(|it| Self { volume: it.volume, profile: it.profile, nodes: it.nodes }).reduce(|a, b| {
            Self {
                volume: a.volume.larger(b.volume),
                profile: a.profile.larger(b.profile),
                nodes: a.nodes.larger(b.nodes),
            }
        })
    }
}

/// A value to compare with, and how far it may be off.
struct Known<T> {
    source: ReferenceKind,
    uncertainty: f64,
    value: T,
}

/// Depths, m, at radii, m.
type Depths<'a> = Box<dyn Fn(&[f64]) -> Vec<f64> + 'a>;

/// The least uncertain. A limit that is far off, or a medium far from Gibson's, is no reference even where there is no other.
fn best<T>(all: impl IntoIterator<Item = Known<T>>) -> Option<Known<T>> {
    const TOO_UNCERTAIN: f64 = 0.1;
    let usable = all.into_iter().filter(|it| it.uncertainty < TOO_UNCERTAIN);
    usable.min_by(|a, b| a.uncertainty.total_cmp(&b.uncertainty))
}

/// All that runs are compared with.
pub(super) struct References {
    shape: Shape,
    /// First contact radius, m, where the edge of stick moves over the ground: there the profile is steep at places that are known to the error of that
    /// edge, and what is measured is the distance of the curves, of depth over the largest or of radius over this one.
    moves_at: Option<f64>,
    limit: Option<LimitingShape>,
    gibson: Option<(GibsonTransient, f64)>,
    reference: RunFile,
    /// Difference of the two references at each snapshot and those around it: volume and depth.
    uncertainty: Vec<[f64; 2]>,
    /// Distance of the reference from the limit at each of its snapshots.
    to_limit: Vec<f64>,
    /// What errors are relative to: a volume, m³, and a depth, m.
    pub(super) scales: [f64; 2],
}

impl References {
    /// From two runs, of which the first is the finer.
    ///
    /// # Errors
    /// Those of the closed form.
    pub(super) fn new(scene: &Scene, references: [RunFile; 2]) -> Result<Self> {
        let [reference, other] = references;
        let contact = scene.contact()?;
        let limit =
            LimitingShape::under(&contact, scene.conditions())?.filter(|it| is_limit_of(it, &reference));
        let moves = reference.checkpoint.as_ref().is_some_and(|it| it.state.stick.is_some());
        let stays = !moves && limit.is_some();
        let shape = Shape::new(&contact, stays, &reference);
        let moves_at = moves.then(|| contact.contact_radius());
        let last = reference.snapshots.last();
        let scales = match &limit {
            Some(limit) => [limit.wear_volume(), limit.wear_depth_max()],
            None => last.map_or([f64::NAN; 2], |it| [it.wear_volume, largest(&it.wear_depth)]),
        };
        let grading = scene.half_space().grading();
        let gibson = match scene.conditions().is_plain() {
            true => GibsonTransient::from_contact(&contact)?.map(|it| (it, 1.0 - grading)),
            false => None,
        };
        let mut references =
            Self { shape, moves_at, limit, gibson, reference, uncertainty: vec![], to_limit: vec![], scales };
        references.uncertainty = references.difference(&other);
        references.to_limit = references.distances_to_limit();
        Ok(references)
    }

    /// Largest differences of the references over all snapshots: volume and depth.
    pub(super) fn largest_uncertainty(&self) -> [f64; 2] {
        self.uncertainty.iter().copied().fold([0.0; 2], larger)
    }

    /// Differences of the reference and the other one at each snapshot: the largest within a factor of two of its cycles, and of its
    /// neighbours, because a difference that changes its sign is small by chance.
    fn difference(&self, other: &RunFile) -> Vec<[f64; 2]> {
        const AROUND: f64 = 2.0;
        let own = &self.reference.snapshots;
        let at = |it: &Snapshot| {
            let Some(theirs) = snapshot(other, it.cycles) else { return [f64::INFINITY; 2] };
            let radii = &self.shape.radii;
            let one = self.shape.depth_at(&self.reference.header.radius, it, radii);
            let two = self.shape.depth_at(&other.header.radius, theirs, radii);
            let volume = (it.wear_volume - theirs.wear_volume).abs();
            [volume / self.scales[0], self.apart(radii, &one, &two)]
        };
        let here: Vec<[f64; 2]> = own.iter().map(at).collect();
        let around = |place: usize| {
            let near = |other: &usize| {
                let ratio = own[*other].cycles / own[place].cycles;
                other.abs_diff(place) <= 1 || (ratio <= AROUND && ratio * AROUND >= 1.0)
            };
            (0..own.len()).filter(near).map(|it| here[it]).fold([0.0; 2], larger)
        };
        (0..own.len()).map(around).collect()
    }

    /// Difference of two profiles at some radii, relative.
    fn apart(&self, radii: &[f64], one: &[f64], two: &[f64]) -> f64 {
        let Some(radius) = self.moves_at else { return distance(one, two) / self.scales[1] };
        let places: Vec<f64> = radii.iter().map(|r| r / radius).collect();
        let [one, two] =
            [one, two].map(|depths| depths.iter().map(|depth| depth / self.scales[1]).collect::<Vec<_>>());
        let from = |(i, depth): (usize, &f64)| distance_from_curve(&places, &two, [places[i], *depth], i);
        one.iter().enumerate().map(from).fold(0.0, f64::max)
    }

    fn distances_to_limit(&self) -> Vec<f64> {
        let Some(limit) = &self.limit else { return vec![] };
        let depths = limit_depths(limit, &self.shape.radii);
        let gap = |it: &Snapshot| {
            let own = self.shape.depth_at(&self.reference.header.radius, it, &self.shape.radii);
            let volume = (it.wear_volume - limit.wear_volume()).abs() / self.scales[0];
            volume.max(distance(&own, &depths) / self.scales[1])
        };
        self.reference.snapshots.iter().map(gap).collect()
    }

    fn reference_at(&self, cycles: f64) -> Option<(&Snapshot, [f64; 2])> {
        let mut all = self.reference.snapshots.iter().zip(&self.uncertainty);
        all.find(|(it, _)| same_cycles(it.cycles, cycles)).map(|(it, uncertainty)| (it, *uncertainty))
    }

    /// Distance of the limit from the run after some cycles: it falls, so that an earlier one is a bound.
    fn limit_at(&self, cycles: f64) -> Option<(&LimitingShape, f64)> {
        let mut before = self.reference.snapshots.iter();
        let place = before.rposition(|it| it.cycles <= cycles * (1.0 + SAME_CYCLES));
        self.limit.as_ref().zip(place.and_then(|place| self.to_limit.get(place).copied()))
    }

    /// The worn volume, m³, after some cycles.
    fn volume(&self, cycles: f64, tau: f64) -> Option<Known<f64>> {
        let reference = self.reference_at(cycles).map(|(it, uncertainty)| Known {
            source: ReferenceKind::Reference,
            uncertainty: uncertainty[0],
            value: it.wear_volume,
        });
        let limit = self.limit_at(cycles).map(|(limit, uncertainty)| Known {
            source: ReferenceKind::Limit,
            uncertainty,
            value: limit.wear_volume(),
        });
        let gibson = self.gibson.as_ref().map(|(gibson, uncertainty)| Known {
            source: ReferenceKind::Gibson,
            uncertainty: *uncertainty,
            value: gibson.wear_volume(tau),
        });
        best([reference, limit, gibson].into_iter().flatten())
    }

    /// The wear depths after some cycles.
    fn depths(&self, cycles: f64, tau: f64) -> Option<Known<Depths<'_>>> {
        let own = &self.reference.header.radius;
        let reference = self.reference_at(cycles).map(|(it, uncertainty)| Known {
            source: ReferenceKind::Reference,
            uncertainty: uncertainty[1],
            value: Box::new(move |radii: &[f64]| self.shape.depth_at(own, it, radii)) as Depths,
        });
        let limit = self.limit_at(cycles).map(|(limit, uncertainty)| Known {
            source: ReferenceKind::Limit,
            uncertainty,
            value: Box::new(move |radii: &[f64]| limit_depths(limit, radii)) as Depths,
        });
        let gibson = self.gibson.as_ref().map(|(gibson, uncertainty)| Known {
            source: ReferenceKind::Gibson,
            uncertainty: *uncertainty,
            value: Box::new(move |radii: &[f64]| radii.iter().map(|r| gibson.wear_depth(*r, tau)).collect())
                as Depths,
        });
        best([reference, limit, gibson].into_iter().flatten())
    }

    /// The errors of a run at each of its snapshots after the start.
    pub(super) fn errors(&self, run: &RunFile) -> Vec<Errors> {
        run.snapshots.iter().filter(|it| it.cycles > 0.0).map(|it| self.errors_at(run, it)).collect()
    }

    fn errors_at(&self, run: &RunFile, snapshot: &Snapshot) -> Errors {
        let unknown = Measured { value: f64::NAN, bounded: false };
        let mut errors = Errors {
            cycles: snapshot.cycles,
            tau: snapshot.tau,
            wear_volume: snapshot.wear_volume,
            wear_volume_reference: f64::NAN,
            sources: [ReferenceKind::None; 2],
            uncertainty: [f64::NAN; 2],
            volume: unknown,
            profile: unknown,
            nodes: unknown,
        };
        if let Some(truth) = self.volume(snapshot.cycles, snapshot.tau) {
            let found = (snapshot.wear_volume - truth.value).abs() / self.scales[0];
            errors.volume = Measured::new(found, truth.uncertainty);
            errors.wear_volume_reference = truth.value;
            (errors.sources[0], errors.uncertainty[0]) = (truth.source, truth.uncertainty);
        }
        if let Some(truth) = self.depths(snapshot.cycles, snapshot.tau) {
            let (own, common) = (&run.header.radius, &self.shape.radii);
            let there = self.shape.depth_at(own, snapshot, common);
            let measured = |depths: &[f64], radii: &[f64]| {
                Measured::new(self.apart(radii, depths, &(truth.value)(radii)), truth.uncertainty)
            };
            errors.profile = measured(&there, common);
            errors.nodes = measured(&snapshot.wear_depth, own);
            (errors.sources[1], errors.uncertainty[1]) = (truth.source, truth.uncertainty);
        }
        errors
    }
}

fn snapshot(run: &RunFile, cycles: f64) -> Option<&Snapshot> {
    run.snapshots.iter().find(|it| same_cycles(it.cycles, cycles))
}

fn larger(one: [f64; 2], two: [f64; 2]) -> [f64; 2] {
    [one[0].max(two[0]), one[1].max(two[1])]
}

/// Whether a run has this limit: the edge of stick may have moved, or no limit be known.
fn is_limit_of(limit: &LimitingShape, run: &RunFile) -> bool {
    const SAME: f64 = 1e-6;
    let depths = limit_depths(limit, &run.header.radius);
    let own = run.header.limit.as_ref();
    own.is_some_and(|own| distance(&own.wear_depth, &depths) <= SAME * limit.wear_depth_max())
}

fn limit_depths(limit: &LimitingShape, radii: &[f64]) -> Vec<f64> {
    let c = limit.stick_radius();
    radii.iter().map(|r| limit.wear_depth_at_offset((r - c) * (r + c))).collect()
}

fn distance(one: &[f64], two: &[f64]) -> f64 {
    one.iter().zip(two).fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()))
}
