//! Why a run cannot begin, or go on: the physical moment, and what can be done.

use super::Simulation;
use super::step::{SMALLEST_FACTOR, SMALLEST_GROWTH};
use crate::error::{Error, Result};
use crate::laws::loading::TangentialControl;
use crate::numerics::linear::{largest, largest_magnitude};
use crate::numerics::roots::SEARCH;
use crate::solver::model::{FEWEST_SPRINGS, Model};

/// What of a run does not converge.
const STEPPING: &str = "time stepping";

/// Contact radius, over the present one, that is about to be reached.
const AHEAD: f64 = 1.02;

/// Part of the contact radius below which few meshes resolve a layer at its edge.
const THIN: f64 = 1e-6;

/// Compression next to the contact edge, over the indentation, and strength of friction there, over that part of the strength at the indentation, from which on wear by the traction
/// spares the edge: exponents of the load of 0.9 come to their ends down to k = -0.9 under a paraboloid, of 0.75 down to -0.7 under a cone, which comes to none at -0.9.
const NEXT_TO_EDGE: f64 = 1e-2;
const SPARED: f64 = 0.06;

/// Compression of springs that pull, and difference by which springs in a row alternate, over the largest compression, and springs less one in such a row, from which on they are why no
/// step leads on.
const PULL: f64 = 0.02;
const SWING: f64 = 0.01;
const IN_A_ROW: usize = 4;

/// Part of the steps of a run that end with a block, from which on blocks are why they are many.
const OF_STEPS: f64 = 0.3;

/// What most meshes of gross slip do not resolve in a medium that is stiff at its top alone: the pressure, `(a² - r²)^ν` at the contact edge, falls to nothing in a layer as thin as `2^(-1/ν)` of it.
fn thin_layer(model: &Model) -> String {
    let grading = model.contact().half_space().grading();
    // Of a number that may be too small for one.
    let magnitude = (-1.0 - 2.0 / (1.0 + grading)) * 2.0_f64.log10();
    // Of which the layer is as thin as that.
    let widest = -1.0 - 2.0 / (2.0 * THIN).log2();
    if magnitude > THIN.log10() {
        return String::new();
    }
    format!(
        " (half_space.grading = {grading}: the pressure at the contact edge falls to half within 1e{magnitude:.0} of the contact radius, where only few meshes lead on; \
         {widest:.2} leaves a layer of {THIN:.0e})"
    )
}

/// Why the contact edge is hard to follow in gross slip, if it is.
fn at_edge(model: &Model) -> String {
    if model.gross().is_some() { spared_edge(model) + &thin_layer(model) } else { String::new() }
}

/// Friction that falls so steeply with the load that its traction hardly wears the contact edge, where that leaves a rim.
fn spared_edge(model: &Model) -> String {
    let (contact, conditions) = (model.contact(), model.schedule().conditions());
    let strength = |part: f64| conditions.friction.kinetic_strength(part * contact.indentation());
    let spared = strength(NEXT_TO_EDGE) < SPARED * NEXT_TO_EDGE * strength(1.0);
    if !(spared && conditions.wear.takes_traction() && contact.half_space().loads_rims()) {
        return String::new();
    }
    " (friction: with the load it falls faster than the pressure towards the contact edge, so that wear spares the ground there, which takes the load; exponents up to 0.9 are followed at \
     gradings down to -0.9 under a paraboloid, up to 0.75 and down to -0.7 under a cone)"
        .to_owned()
}

/// What the compressions of the springs tell about why no step leads on, if anything.
fn by_compressions(model: &Model, compression: &[f64]) -> String {
    let most = largest_magnitude(compression);
    let pull = compression.iter().fold(0.0, |least: f64, it| least.min(*it)).abs();
    if model.schedule().conditions().wear.spreading().is_some() && pull > PULL * most {
        return format!(
            " (wear.non-local: debris has worn the ground away from under the pressure, so that springs pull with up to {:.2} of the largest compression, and a rim takes the load)",
            pull / most
        );
    }
    let swing = swing(compression);
    if swing <= SWING * most {
        return String::new();
    }
    format!(
        " (numerics.springs: compressions swing from spring to spring by {:.2} of the largest, for what changes there is narrower than springs are apart)",
        swing / most
    )
}

/// The largest difference that many springs in a row alternate by at least.
///
/// ```text
/// max_i max_± min_{j < n} ±(-1)^j (q_{i+j+1} - q_{i+j})
/// ```
fn swing(compression: &[f64]) -> f64 {
    let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    let turned = |(i, pair): (usize, &[f64])| sign(i) * (pair[1] - pair[0]);
    let differences: Vec<f64> = compression.windows(2).enumerate().map(turned).collect();
    // Those that alternate are now of one sign.
    let least = |run: &[f64]| {
        let [least, most] =
            run.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], it| [a.min(*it), b.max(*it)]);
        least.max(-most)
    };
    differences.windows(IN_A_ROW).map(least).fold(0.0, f64::max)
}

/// What cuts steps short where blocks follow one another as fast.
fn by_blocks(model: &Model, cycles: f64, steps: u64) -> String {
    let ends = model.schedule().breaks_until(cycles);
    if ends < OF_STEPS * steps as f64 {
        return String::new();
    }
    format!(" (loading.blocks: {ends:.0} blocks ended on the way, and a step with each)")
}

/// Why a run cannot begin.
pub(super) fn nothing_wears(model: &Model, finite: bool) -> Error {
    let contact = model.contact();
    if !finite {
        let why = format!(
            "on {} springs slip next to the edge of stick has no digits left; ask for fewer",
            model.springs()
        );
        return Error::Inconsistent { what: "numerics.springs", why };
    }
    let by_law = model.schedule().conditions().wear.keeps_from_wearing(contact.mean_pressure());
    let (what, why) = match by_law {
        Some(by_law) => by_law,
        None if model.gross().is_some() => {
            let (springs, layer) = (model.springs(), at_edge(model));
            let why = format!(
                "{springs} springs over the whole contact do not carry its first pressure, and by them nothing wears in the first cycles{layer}; ask for others"
            );
            ("numerics.springs", why)
        }
        None => {
            let why = format!(
                "at an amplitude of {:e} m nothing wears in the first cycles; ask for a larger one",
                contact.amplitude()
            );
            ("loading.amplitude", why)
        }
    };
    Error::Inconsistent { what, why }
}

impl Simulation {
    /// Whether there is a first step, of any length above round-off, that leads to a contact.
    ///
    /// # Errors
    /// Those of the stepper.
    pub fn begins(&mut self) -> Result<bool> {
        let (mut step, fastest) = (self.progress.next_step, largest(&self.cycle.growth));
        while step * fastest > SMALLEST_GROWTH {
            let found = self.stepper.step(&self.model, &self.state, step)?;
            self.stepper.forget();
            if found.state.is_some() && found.error.is_finite() {
                return Ok(true);
            }
            step *= SMALLEST_FACTOR;
        }
        Ok(false)
    }

    /// The moment at which no stick is left under a force that is held, which the contact then no longer bears.
    pub(super) fn slides_off(&self) -> Error {
        let then = match self.model.schedule().conditions().tangential_control {
            TangentialControl::Rig { .. } => {
                "moves as a whole with the rig, which is followed at gradings from -0.5 on where friction does not rise"
            }
            _ => "is in gross slip and no longer bears the tangential force that is asked for",
        };
        Error::NotConverged {
            what: STEPPING,
            why: format!(
                "{}: from there the contact {then}; end before (loading.tau), or ask for a smaller amplitude",
                self.moment_of_loss()
            ),
        }
    }

    /// Dimensionless time after some cycles.
    fn tau(&self, cycles: f64) -> f64 {
        cycles * self.model.contact().tau_per_cycle()
    }

    /// The moment from which on a rig no longer breaks all springs away.
    pub(super) fn held_again(&self) -> Error {
        let cycles = self.state.cycles;
        let tau = self.tau(cycles);
        Error::NotConverged {
            what: STEPPING,
            why: format!(
                "at cycle {cycles:.6e} (τ = {tau:.5}) the rig no longer breaks all springs away as its motion reverses: they are held up to the mean of both \
                 limits of friction, and which of them stick is decided by the past of each; end before (loading.tau), ask for a larger amplitude, or take \
                 friction.coulomb"
            ),
        }
    }

    /// When and where stick is lost.
    pub(super) fn moment_of_loss(&self) -> String {
        let (model, state) = (&self.model, &self.state);
        let cycles = state.cycles + model.cycles_to_loss(state);
        let tau = self.tau(cycles);
        let radius = self.cycle.stick_radius;
        format!(
            "stick is lost at cycle {cycles:.6e} (τ = {tau:.5}), at last within the radius {radius:.4e} m"
        )
    }

    /// A failure, with the moment before at which a rig broke the last stick: what is left there of ground that has not worn may be too narrow a column to follow.
    fn after_loss(&self, why: String) -> String {
        match &self.let_go {
            Some(moment) => {
                format!(
                    "{moment}: from there the contact moves with the rig, on a narrow column that is followed only so far: {why}"
                )
            }
            None => why,
        }
    }

    /// An error of a step, with the moment, which a search within it does not know.
    pub(super) fn timed(&self, error: Error) -> Error {
        match error {
            Error::NotConverged { .. } if self.model.is_losing_stick(&self.state) => self.slides_off(),
            Error::NotConverged { what: SEARCH, .. } => self
                .stuck("no place is found for the edge of stick or of contact at which the forces balance"),
            Error::NotConverged { what, why } if what != STEPPING => self.stuck(&format!("{what}: {why}")),
            other => other,
        }
    }

    /// How far a run came that takes more steps than it may by itself.
    pub fn takes_too_long(&self) -> Error {
        let (model, progress, cycles) = (&self.model, &self.progress, self.state.cycles);
        let tau = self.tau(cycles);
        let [stick, edge] = [model.without_core(self.cycle.stick_radius), model.contact_radius(&self.state)];
        Error::NotConverged {
            what: STEPPING,
            why: self.after_loss(format!(
                "at cycle {cycles} (τ = {tau:.4e}), with slip from the radius {stick:.4e} m to the contact radius {edge:.4e} m, wear goes on in steps of {:.1e} \
                 cycles{}{}{}, and {} were tried on {} springs; end before (loading.tau = {tau:.3e}), or go on by hand (numerics.springs and numerics.tolerance), \
                 however long it takes",
                progress.next_step,
                at_edge(model),
                by_compressions(model, &self.state.compression),
                by_blocks(model, cycles, progress.steps),
                progress.steps + progress.rejected_steps,
                model.springs()
            )),
        }
    }

    /// The refusal of a run in gross slip of which a coarse one takes more work than a run may by itself.
    pub fn reaches_too_slowly(&self) -> Error {
        let (model, progress, cycles) = (&self.model, &self.progress, self.state.cycles);
        let tau = self.tau(cycles);
        let why = format!(
            "in gross slip wear goes on in steps of {:.1e} cycles, of which {} on {} springs lead to cycle {cycles} (τ = {tau:.4e}), and how far the contact comes to reach \
             would take too long to find; end before (loading.tau = {tau:.3e})",
            progress.next_step,
            progress.steps + progress.rejected_steps,
            model.springs()
        );
        Error::Inconsistent { what: "loading", why }
    }

    /// The moment at which a run cannot go on, and what can be done.
    pub(super) fn stuck(&self, why: &str) -> Error {
        let (model, cycles) = (&self.model, self.state.cycles);
        let tau = self.tau(cycles);
        let [stick, edge] = [model.without_core(self.cycle.stick_radius), model.contact_radius(&self.state)];
        let healed = self.healed_at.map_or(String::new(), |radius| {
            format!(", for at the radius {radius:.4e} m wear depth would become less")
        });
        let springs = model.springs();
        let height = model.contact().indenter().profile(AHEAD * edge);
        let ends = model.gross().is_some() && !height.is_finite();
        let why = if ends { "the profile of the indenter ends there" } else { why };
        let other = if model.gross().is_some() { 3 * springs / 4 } else { 2 * springs };
        let springs = match ends || other < FEWEST_SPRINGS {
            true => String::new(),
            false => format!("ask for {other} springs (numerics.springs; there were {springs}), or "),
        };
        let cure = match cycles > 0.0 {
            true => format!("end before (loading.tau = {tau:.3e})"),
            false => "ask for another loading.amplitude".into(),
        };
        Error::NotConverged {
            what: STEPPING,
            why: self.after_loss(format!(
                "at cycle {cycles} (τ = {tau:.4e}), with slip from the radius {stick:.4e} m to the contact radius {edge:.4e} m: {why}{healed}{layer}{shown}; \
                 {springs}{cure}",
                layer = at_edge(model),
                shown = by_compressions(model, &self.state.compression)
            )),
        }
    }
}
