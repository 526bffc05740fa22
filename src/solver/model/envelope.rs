//! The envelope of all cycles of a run: the largest indentation and the smallest stick radius bound where wear can come.

use super::moving::{
    LAST_CORE, check_friction, first_slip_compression, follows_held_force, held_stick_radius, jumps_steeply,
    slides_at_once,
};
use super::schedule::{CycleLoading, Envelope, Schedule};
use super::whole::{LEAST_STICK, not_carried};
use crate::contact::InitialContact;
use crate::error::{Error, Result};
use crate::laws::loading::TangentialControl;
use crate::numerics::roots::bracketed;

/// Steps in the search for the last stick radius.
const SEARCH: usize = 400;

/// Contact radius over the first up to which springs that slip are taken to spread what they bear.
const FARTHEST: f64 = 2.0;

/// Parts of the load that springs that slip may bear at which its friction is looked at.
const SHED: usize = 24;

impl Schedule {
    /// The contact at the largest indentation of the run, with the edge of stick where springs slip in some cycle of it.
    ///
    /// Where a balance of forces takes all stick away in the end, with the [core](LAST_CORE) up to which that is followed, or without following the edge of stick.
    ///
    /// # Errors
    /// [`Error::Inconsistent`](crate::Error::Inconsistent) if the whole contact slides in some cycle, which is not stepped on this mesh; those of [`InitialContact::at`].
    pub fn envelope(&self, contact: &InitialContact) -> Result<Envelope> {
        let same = [contact.indentation(), contact.amplitude()];
        if let Some((of, found)) = self.known_envelope().get()
            && *of == same
        {
            return Ok(found.clone());
        }
        let found = self.envelope_of(contact)?;
        // Another thread may have found the same.
        let _ = self.known_envelope().set((same, found.clone()));
        Ok(found)
    }

    /// [`Schedule::envelope`], which takes a search for the edge of stick on some paths.
    fn envelope_of(&self, contact: &InitialContact) -> Result<Envelope> {
        let (depth, conditions) = (self.largest_indentation(), self.conditions());
        let compression = self.largest_slip_compression(contact)?;
        let radius = self.largest_first_radius(contact)?;
        let largest = depth - contact.equivalent_profile().value(LEAST_STICK * radius);
        let slides = compression > largest;
        let at_once = slides_at_once(self, contact)?;
        let accelerates = match conditions.tangential_control {
            TangentialControl::Force if conditions.holds_both_forces() => slides,
            TangentialControl::Force => at_once,
            _ => false,
        };
        if accelerates {
            return Err(Error::Inconsistent {
                what: "loading.amplitude",
                why: format!(
                    "at an amplitude of {:e} m the contact is in gross slip, or nearly, and a tangential force that is held would accelerate it; reduce \
                     it, or hold the amplitude: leave out loading.tangential_control",
                    contact.amplitude()
                ),
            });
        }
        let follows = follows_held_force(self, contact)?;
        if !slides {
            return Ok(Envelope { contact: contact.at(depth, compression)?, slides });
        }
        if !follows {
            check_friction(self, contact, follows)?;
            let given = conditions.tangential_control == TangentialControl::Displacement;
            if given || at_once || jumps_steeply(self, contact) {
                return Err(not_carried(contact, self));
            }
        }
        Ok(Envelope { contact: contact.with_core(depth, LAST_CORE * radius)?, slides })
    }

    /// Contact radius, m, at the largest indentation, without wear.
    ///
    /// # Errors
    /// As [`EquivalentProfile::radius_at`](crate::contact::indenter::EquivalentProfile::radius_at).
    pub(super) fn largest_first_radius(&self, contact: &InitialContact) -> Result<f64> {
        match self.largest_indentation() {
            same if same == contact.indentation() => Ok(contact.contact_radius()),
            deeper => contact.equivalent_profile().radius_at(deeper),
        }
    }

    /// The largest compression, m, at which springs slip in some cycle, from the largest indentation; all of that where no stick is left.
    ///
    /// # Errors
    /// As [`EquivalentProfile::radius_at`](crate::contact::indenter::EquivalentProfile::radius_at).
    pub(super) fn largest_slip_compression(&self, contact: &InitialContact) -> Result<f64> {
        let ratio = contact.half_space().stiffness_ratio();
        let depth = self.largest_indentation();
        let first = self.conditions().tangential_control == TangentialControl::Displacement;
        let profile = contact.equivalent_profile();
        let conditions = self.conditions();
        let both = conditions.holds_both_forces();
        let coulomb = conditions.friction.coefficient().is_some();
        let rests = conditions.holds_normal_force && conditions.friction.remembers_slip();
        if rests && !first {
            let slipping = |loading| first_slip_compression(contact, &loading, contact.indentation());
            Ok(self.extremes().map(slipping).collect::<Result<Vec<f64>>>()?.into_iter().fold(0.0, f64::max))
        } else if conditions.holds_normal_force && !first && !(both && coulomb) {
            let least = self.extremes().map(|loading| least_stick_radius(contact, &loading));
            let least = least.collect::<Result<Vec<f64>>>()?.into_iter().fold(f64::INFINITY, f64::min);
            Ok(depth - profile.value(least))
        } else if both && !self.keeps_friction() {
            // Falling friction lets the edge of stick recede over unworn ground; rising friction lets it creep from where it is at first.
            let edge = |loading| held_stick_radius(contact, contact.normal_force(), &loading);
            let least = self.extremes().map(|loading| edge(loading).unwrap_or_default());
            Ok(depth - profile.value(least.fold(f64::INFINITY, f64::min)))
        } else if first || both {
            Ok(self.extremes().map(|loading| loading.slip_compression(ratio)).fold(0.0, f64::max))
        } else {
            self.last_slip_compression(contact)
        }
    }

    /// Compression at the edge of stick when wear has taken all load off the slipping springs, m, with the tangential amplitude that the
    /// balance of forces then gives; the whole indentation if stick cannot bear the load.
    ///
    /// ```text
    /// F_x(c) = 2 μ_f c_N (d - g0(c)) c^(1+k)/(1+k),    F_x(c) = Q    or    U(c) + F_x(c)/k_r = U_r,  M U(c) = μ_f (d - g0(c))
    /// ```
    fn last_slip_compression(&self, contact: &InitialContact) -> Result<f64> {
        let half_space = contact.half_space();
        let ratio = half_space.stiffness_ratio();
        let exponent = 1.0 + half_space.grading();
        let profile = contact.equivalent_profile();
        let mut largest = 0.0_f64;
        for loading in self.extremes() {
            let depth = self.largest_indentation() - loading.lift;
            let excess = |radius: f64| {
                let strength = loading.friction.static_strength(depth - profile.value(radius));
                let force = 2.0 * half_space.normal_stiffness() * strength * radius.powf(exponent) / exponent;
                loading.excess(force, strength / ratio)
            };
            let edge = outermost_balance(profile.radius_at(depth)?, exponent, excess)?;
            let compression = edge.map_or(depth, |edge| depth - profile.value(edge));
            largest = largest.max(compression + loading.lift);
        }
        Ok(largest)
    }
}

/// Least radius of stick, m, that a balance of tangential forces under a held normal force leaves on the way to where wear has taken all load off the springs that slip and unworn ground within bears both; zero where the
/// contact slides at once or in the end.
///
/// ```text
/// F_N = 2 c_N [∫_0^c x^k (d - g_0) dx + L],    F_x = 2 c_N [τ(d - g_0(c)) c^(1+k)/(1+k) + T]
/// ```
///
/// In the end `L = T = 0`. On the way springs that slip bear `L ≥ 0` at some indentation `d` beyond the first, and by friction no less than `T`: that of the load on as few springs as can
/// bear it or, where friction rises with the load, spread evenly over as many as there may be.
///
/// # Errors
/// As [`EquivalentProfile::radius_at`].
fn least_stick_radius(contact: &InitialContact, loading: &CycleLoading) -> Result<f64> {
    let (profile, half_space) = (contact.equivalent_profile(), contact.half_space());
    let (ratio, exponent) = (half_space.stiffness_ratio(), 1.0 + half_space.grading());
    let edge = contact.contact_radius();
    let Ok(first) = first_slip_compression(contact, loading, contact.indentation()) else { return Ok(0.0) };
    let first = profile.radius_at(contact.indentation() - first)?;
    let stiffness = half_space.normal_stiffness();
    let borne = 0.5 * contact.normal_force() / stiffness;
    let excess = |radius: f64, shed: f64| {
        let area = radius.powf(exponent) / exponent;
        let most = (borne - 0.5 * profile.load_integral(radius)) / area;
        let least = (contact.indentation() - profile.value(radius)).min(most);
        let compression = most - shed * (most - least);
        let strength = loading.friction.static_strength(compression);
        let load = area * (most - compression);
        let beyond = (FARTHEST * edge).powf(exponent) / exponent - area;
        let spread = beyond * loading.friction.static_strength(load / beyond);
        let slipping = (load / compression * strength).min(spread);
        loading.excess(2.0 * stiffness * (strength * area + slipping), strength / ratio)
    };
    let Some(in_the_end) = outermost_balance(edge, exponent, |radius| excess(radius, 0.0))? else {
        return Ok(0.0);
    };
    if loading.friction.coefficient().is_some() {
        return Ok(in_the_end.min(first));
    }
    let least = |radius: f64| {
        let by_shed = (0..=SHED).map(|i| excess(radius, i as f64 / SHED as f64));
        by_shed.fold(f64::INFINITY, f64::min)
    };
    let on_the_way = outermost_balance(edge, exponent, least)?.unwrap_or_default();
    Ok(on_the_way.max(LAST_CORE * edge).min(in_the_end).min(first))
}

/// The first radius, m, from the contact edge inwards at which a balance of forces holds; none down to `e^(-16/(1+k))` of that edge. Stick is lost from there.
///
/// # Arguments
/// * `edge` -- contact radius, m
/// * `exponent` -- `1+k`
/// * `excess` -- of the forces over what is asked for, with the edge of stick at a radius, m
///
/// # Errors
/// As [`bracketed`].
fn outermost_balance(edge: f64, exponent: f64, excess: impl Fn(f64) -> f64) -> Result<Option<f64>> {
    let inwards = |i: usize| edge * (-16.0 * i as f64 / (SEARCH as f64 * exponent)).exp();
    let first = (1..=SEARCH).find(|i| excess(inwards(*i)) >= 0.0);
    first.map(|i| bracketed(excess, inwards(i), inwards(i - 1), 0.0)).transpose()
}
