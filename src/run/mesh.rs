//! The springs of a run: as many as the unworn contact and the limit need, or those asked for if they carry them.

use super::budget::{
    MOST_RAISED, most_that_stick, smallness, springs_before, springs_for, springs_in_gross_slip,
};
use super::memory::memory_figure;
use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::error::{Error, Result};
use crate::laws::loading::Duration;
use crate::numerics::abel::Backend;
use crate::numerics::grid::Clustering;
use crate::scene::{Numerics, Stepper};
use crate::solver::model::{FEWEST_SPRINGS, Gross, Model, OperatorStore, Schedule};

/// Fewest springs that carry a contact which loses its stick in the end: their mesh begins at a fiftieth of its radius.
pub(super) const SPRINGS_TO_SLIDE: usize = 60;

/// Fewest springs of gross slip from which one goes over to springs by hand.
const FEWEST_BY_HAND: usize = 12;

/// Grading below which nodes cluster as `N^-2` at the edge of stick. There the depth of the limit is nearly linear, so that finer ones resolve
/// nothing, and where the pressure at the edge blows up they are unstable (docs/extremes.md).
const STEEP_SOFTENING: f64 = -0.5;

/// `ln(g(a0)/g(c))` from which on, there, polynomials of high degree take longer than cubics, if they survive that.
const SMALL_STICK: f64 = 10.0;

/// Largest error of the unworn compressions, over `q_c`, with springs asked for by number.
const COARSEST: f64 = 0.05;

/// The same with springs chosen by the program.
const COARSE: f64 = 0.01;

/// Largest error of the limit's worn volume, relative, with springs asked for by number.
const COARSEST_VOLUME: f64 = 0.1;

/// Largest round-off in the logarithm of the unworn slip, which is zero: next to the edge of stick slip is the difference of nearly equal
/// numbers.
const ROUND_OFF: f64 = 1e-2;

/// Most by which the unworn contact may pull somewhere, over its mean pressure, where wear is not in proportion to pressure and slip: next to a tiny edge of stick what
/// presses on springs is the small difference of large numbers, which takes part in no other sum. Contacts off by less come to their ends (measured: 5e2 does, 8e5 does not).
const MOST_PULL: f64 = 1e3;

/// Factor by which the number of springs is raised when they do not carry the scene.
const RAISE: f64 = 1.3;

/// Bytes held per pair of springs: two transforms, the factors of one, and Newton's matrix with its factors.
const BYTES_PER_PAIR: f64 = 5.0 * 8.0;

/// Bytes held per spring where operators are hierarchical.
const BYTES_PER_SPRING: f64 = 12e3;

/// Wear at the first pressures, over the compression at the edge of stick, from which on the front of wear is followed: at 3 it comes to that edge
/// (docs/numerics.md).
const FRONT: f64 = 2.0;

/// Most springs with which a threshold is followed on the mesh of an orbit: on 240, whose cells at the contact edge are narrower, some runs came to no end.
const MOST_AT_THRESHOLD: usize = 128;

/// How well a mesh carries what is known beforehand.
struct Quality {
    /// Largest error of the unworn compressions over `q_c`.
    compression: f64,
    /// Relative error of the limit's worn volume.
    volume: f64,
    /// Largest logarithm of the unworn slip over itself.
    round_off: f64,
    /// By how much the unworn contact pulls where it should press, over its mean pressure.
    pull: f64,
}

/// The model of a scene on a mesh that carries it.
///
/// # Arguments
/// * `duration` -- of the run
/// * `wanted` -- springs to begin with where none are given by hand, instead of those for the accuracy
///
/// # Errors
/// [`Error::Inconsistent`] if the springs asked for do not carry the scene or do not fit into memory; those of [`Model::under`].
pub(super) fn model(
    contact: &InitialContact,
    schedule: &Schedule,
    duration: Duration,
    numerics: &Numerics,
    wanted: Option<usize>,
    store: &OperatorStore,
) -> Result<Model> {
    if numerics.stepper == Stepper::Implicit {
        if let Some(model) = nearly_sliding(contact, schedule, numerics, wanted) {
            return Ok(model);
        }
        if let Some((partial, before)) = Gross::before(contact, schedule)? {
            let most = most_that_stick(contact);
            let bounds = [springs_in_gross_slip(contact, schedule, numerics.accuracy), most];
            let model = on_enough_springs(&partial, &before, duration, numerics, (wanted, bounds), store)?;
            if model.springs() <= most {
                return Ok(model);
            }
        }
    }
    on_enough_springs(contact, schedule, duration, numerics, (wanted, [FEWEST_SPRINGS, MOST_RAISED]), store)
}

/// The same on a mesh that begins at an edge of stick, or over the whole contact if all of it slides.
///
/// # Arguments
/// * `wanted`, `bounds` -- springs to begin with, where those for the accuracy are not given; and the fewest and most of these
fn on_enough_springs(
    contact: &InitialContact,
    schedule: &Schedule,
    duration: Duration,
    numerics: &Numerics,
    (wanted, [fewest, most]): (Option<usize>, [usize; 2]),
    store: &OperatorStore,
) -> Result<Model> {
    let given = numerics.springs;
    let grading = contact.half_space().grading();
    let concentrated = grading < STEEP_SOFTENING && smallness(contact) > SMALL_STICK;
    let clusterings = |springs: usize| -> &[Clustering] {
        match numerics.stepper {
            Stepper::Implicit if schedule.wears_smoothly() && !concentrated => {
                &[Clustering::Smooth, Clustering::CreepingStick]
            }
            _ if grading < STEEP_SOFTENING => &[Clustering::CreepingStick],
            Stepper::Implicit if schedule.wears_nearly_smoothly() || threshold_serves(schedule, springs) => {
                &[Clustering::Even, Clustering::CreepingStick]
            }
            Stepper::Implicit if front_comes(contact, schedule, duration) => {
                &[Clustering::Front, Clustering::CreepingStick]
            }
            Stepper::Implicit => &[Clustering::Cubic, Clustering::CreepingStick],
            Stepper::EveryCycle | Stepper::CycleJump => &[Clustering::Quadratic],
        }
    };
    let chosen = || {
        springs_for(clusterings(FEWEST_SPRINGS)[0], contact, schedule, numerics.accuracy).clamp(fewest, most)
    };
    let mut springs = given.or(wanted).unwrap_or_else(chosen);
    let key = if given.is_some() { "numerics.springs" } else { "numerics.accuracy" };
    check_memory(key, springs, contact, schedule)?;
    let pull = if schedule.wears_by_pressure_alone() { f64::INFINITY } else { MOST_PULL };
    let allowed = match given {
        Some(_) => Quality { compression: COARSEST, volume: COARSEST_VOLUME, round_off: ROUND_OFF, pull },
        None => Quality { compression: COARSE, volume: numerics.accuracy, round_off: ROUND_OFF, pull },
    };
    let raises = given.or(wanted).is_none();
    'springs: loop {
        let mut found = None;
        for clustering in clusterings(springs) {
            let model = Model::under(contact, schedule.clone(), springs, *clustering, store)?;
            if model.gross().is_some() {
                return Ok(model);
            }
            if raises && model.slides() && springs < SPRINGS_TO_SLIDE {
                springs = SPRINGS_TO_SLIDE;
                continue 'springs;
            }
            // Where the edge of stick moves, what is known beforehand belongs to another mesh.
            if model.moving().is_some() {
                return Ok(model);
            }
            let quality = Quality::of(&model)?;
            if quality.within(&allowed) {
                return Ok(model);
            }
            found = Some(quality);
        }
        let raised = (RAISE * springs as f64).ceil() as usize;
        if given.is_some() || raised > MOST_RAISED {
            let quality = found.expect("there is a clustering");
            return Err(too_coarse(contact, springs, given.is_some(), &quality));
        }
        springs = raised;
    }
}

/// The mesh of gross slip for a contact that hardly sticks at first, and whose springs soon stick farther out.
fn nearly_sliding(
    contact: &InitialContact,
    schedule: &Schedule,
    numerics: &Numerics,
    wanted: Option<usize>,
) -> Option<Model> {
    if !Gross::nearly_follows(contact, schedule) {
        return None;
    }
    let by_hand = |springs| springs_before(springs).max(FEWEST_BY_HAND);
    let chosen = || springs_in_gross_slip(contact, schedule, numerics.accuracy);
    let springs = numerics.springs.map(by_hand).or(wanted).unwrap_or_else(chosen);
    let model = Model::in_gross_slip(contact, schedule.clone(), springs).ok()?;
    // Profiles that end may not reach as far as the mesh of an edge of stick asks for.
    model.taken_up(FEWEST_SPRINGS).ok().flatten()?;
    Some(model)
}

/// Whether kinks that a threshold makes are followed on narrow cells.
fn threshold_serves(schedule: &Schedule, springs: usize) -> bool {
    schedule.makes_weak_kinks() && springs <= MOST_AT_THRESHOLD
}

/// Whether the front of wear comes near the edge of stick before a run ends. Where wear spreads, or a held force lets the indentation grow, cubics that
/// are finer in the middle do better.
fn front_comes(contact: &InitialContact, schedule: &Schedule, duration: Duration) -> bool {
    let conditions = schedule.conditions();
    if conditions.wear.spreading().is_some() || conditions.holds_normal_force {
        return false;
    }
    let tau = match duration {
        Duration::Cycles(cycles) => cycles * contact.tau_per_cycle(),
        Duration::Tau(tau) => tau,
        Duration::UntilRate(_) => return true,
    };
    tau * contact.slip_compression() > FRONT * contact.indentation()
}

impl Quality {
    fn of(model: &Model) -> Result<Self> {
        let contact = model.contact();
        let unusable = Self {
            compression: f64::INFINITY,
            volume: f64::INFINITY,
            round_off: f64::INFINITY,
            pull: f64::INFINITY,
        };
        let stick_radius = contact.stick_radius().filter(|_| contact.slip_compression() > 0.0);
        let (Ok(state), Some(stick_radius)) = (model.initial_state(), stick_radius) else {
            return Ok(unusable);
        };
        let most = contact.slip_compression();
        let nodes = &model.operators().nodes()[1..];
        let exact = |x: f64| most - contact.equivalent_profile().rise(stick_radius, state.slip_area * x);
        let errors = state.compression.iter().zip(nodes).map(|(q, x)| (q - exact(*x)).abs() / most);
        let fields = model.fields(&state);
        let limit = LimitingShape::from_contact(contact)?;
        let volume = limit.map(|limit| (model.limit_volume() / limit.wear_volume() - 1.0).abs());
        Ok(Self {
            compression: largest(errors),
            volume: largest(volume.into_iter()),
            round_off: largest(fields.log_slip.iter().map(|log| log.abs())),
            pull: largest(fields.pressure.iter().map(|p| -p / contact.mean_pressure())),
        })
    }

    fn within(&self, allowed: &Self) -> bool {
        self.compression <= allowed.compression
            && self.volume <= allowed.volume
            && self.round_off <= allowed.round_off
            && self.pull <= allowed.pull
    }
}

/// The largest of some magnitudes; infinite where one is not a number.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most: f64, value| if value.is_nan() { f64::INFINITY } else { most.max(value) })
}

fn too_coarse(contact: &InitialContact, springs: usize, by_hand: bool, quality: &Quality) -> Error {
    let ratio = contact.stick_logarithm().map_or(0.0, |logarithm| (-logarithm).exp());
    let off = if quality.compression.is_finite() {
        format!(
            "off by {:.1e} of the largest compression, the limit's volume by {:.1e} of itself, slip by {:.1e} of itself, the pressure next to the edge of stick by {:.1e} of its mean",
            quality.compression, quality.volume, quality.round_off, quality.pull
        )
    } else {
        "not found at all".into()
    };
    let what = if by_hand { "numerics.springs" } else { "numerics.accuracy" };
    let more = if quality.round_off > ROUND_OFF && quality.compression < COARSE { "fewer" } else { "more" };
    let cure = if by_hand {
        format!("ask for {more} springs (numerics.accuracy chooses), or for a smaller amplitude")
    } else {
        "ask for a smaller amplitude, or for more springs by hand (numerics.springs)".into()
    };
    let why = format!(
        "{springs} springs do not carry this contact, whose stick radius is {ratio:.3e} of the contact radius: with them the unworn contact is \
         {off}; {cure}"
    );
    Error::Inconsistent { what, why }
}

/// Refuses springs for which the operators do not fit into the memory that is free.
fn check_memory(
    key: &'static str,
    springs: usize,
    contact: &InitialContact,
    schedule: &Schedule,
) -> Result<()> {
    let Some(free) = free_memory() else { return Ok(()) };
    let backend = Model::backend(contact, schedule, springs);
    let needed = operator_bytes(backend, springs);
    if needed < free {
        return Ok(());
    }
    let most = match backend {
        Backend::Dense => (free / BYTES_PER_PAIR).sqrt(),
        Backend::Hierarchical => free / BYTES_PER_SPRING,
    };
    Err(Error::Inconsistent {
        what: key,
        why: format!(
            "{springs} springs need {:.1} GB for their operators and {:.1} GB are free; ask for at most {} (numerics.springs)",
            needed * 1e-9,
            free * 1e-9,
            most.floor()
        ),
    })
}

/// Memory, bytes, that operators take with Newton's matrix and its factors, about.
pub(crate) fn operator_bytes(backend: Backend, springs: usize) -> f64 {
    let springs = springs as f64;
    match backend {
        Backend::Dense => BYTES_PER_PAIR * springs * springs,
        Backend::Hierarchical => BYTES_PER_SPRING * springs,
    }
}

/// Free memory, bytes, where the system tells.
fn free_memory() -> Option<f64> {
    memory_figure("/proc/meminfo", "MemAvailable:")
}
