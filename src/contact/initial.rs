//! The unworn contact that a scene describes: how deep, how wide, how hard, and what of it slips.

use std::f64::consts::PI;

use crate::contact::half_space::HalfSpace;
use crate::contact::indenter::{EquivalentProfile, Indenter};
use crate::contact::stick_slip::{Regime, full_sliding_amplitude, stick_logarithm};
use crate::error::{Error, Result};
use crate::laws::friction::Coulomb;
use crate::laws::loading::{Amplitude, Loading};
use crate::laws::wear::{Archard, Scales, WearLaw};
use crate::numerics::quadrature::Rule;

mod press;
mod slip;

use press::Press;
use slip::Slip;

/// `ln(a0/c)` below which the load on the slip annulus is integrated over that, and nodes of the quadrature.
const NARROW: f64 = 0.7;
const NODES: usize = 40;

/// The contact before any wear; every quantity is finite.
///
/// # Examples
/// ```
/// use fretwear::contact::InitialContact;
/// use fretwear::laws::friction::Coulomb;
/// use fretwear::contact::half_space::HalfSpace;
/// use fretwear::contact::indenter::Indenter;
/// use fretwear::laws::loading::{Amplitude, Duration, Load, Loading};
/// use fretwear::laws::wear::Archard;
///
/// // k = 0: a0 = √(R d), F_N = (4/3) c_N √R d^(3/2) (Hertz)
/// let contact = InitialContact::new(
///     &Indenter::paraboloid(4.0)?,
///     &HalfSpace::from_stiffness(0.0, 3e9, 0.8)?,
///     &Coulomb { coefficient: 0.5 },
///     &Archard { coefficient: 1e-14 },
///     &Loading {
///         load: Load::Indentation(0.01),
///         amplitude: Amplitude::StickRatio(0.5),
///         duration: Duration::Tau(30.0),
///     },
/// )?;
/// assert!((contact.contact_radius() - 0.2).abs() < 1e-15);
/// assert!((contact.normal_force() / 8e6 - 1.0).abs() < 1e-14);
/// assert!((contact.slip_compression() - 0.0075).abs() < 1e-16);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct InitialContact {
    indenter: Indenter,
    half_space: HalfSpace,
    friction: Coulomb,
    wear: Archard,
    equivalent_profile: EquivalentProfile,
    indentation: f64,
    contact_radius: f64,
    normal_force: f64,
    amplitude: f64,
    /// Whether the amplitude follows from the stick radius asked for.
    amplitude_by_stick: bool,
    slip_compression: f64,
    /// `η = ln(a0/c)`; none under full sliding.
    stick_logarithm: Option<f64>,
    tau_per_cycle: f64,
}

impl InitialContact {
    /// Forms the contact.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the key of the scene; [`Error::Inconsistent`] if a sphere would sink in to its equator, or names the
    /// quantity that values each allowed make too large or too small for a double.
    pub fn new(
        indenter: &Indenter,
        half_space: &HalfSpace,
        friction: &Coulomb,
        wear: &Archard,
        loading: &Loading,
    ) -> Result<Self> {
        positive("friction.coulomb.coefficient", friction.coefficient)?;
        positive("wear.archard.coefficient", wear.coefficient)?;
        let profile = indenter.equivalent_profile(half_space.grading())?;
        let press = Press::new(&profile, half_space.normal_stiffness(), loading.load)?;
        let Press { indentation, contact_radius, normal_force } = press;
        let mean_pressure = normal_force / (PI * contact_radius * contact_radius);
        representable("mean pressure, Pa", mean_pressure, &["loading", "indenter", "half_space"])?;

        let stiffness_ratio = half_space.stiffness_ratio();
        let sliding = full_sliding_amplitude(stiffness_ratio, friction.coefficient, indentation);
        representable("amplitude of full sliding μ_f d/M, m", sliding, &["friction"])?;
        let slip = Slip::new(&profile, &press, half_space, friction.coefficient, loading.amplitude)?;

        let radial = contact_radius.powf(half_space.grading() - 1.0);
        let tau_per_cycle = 4.0 * (wear.coefficient * half_space.normal_stiffness()) * (radial * sliding);
        let what = "dimensionless time per cycle 4 k_w c_N a0^(k-1) μ_f d/M";
        representable(what, tau_per_cycle, &["wear", "half_space", "loading"])?;
        Ok(Self {
            indenter: indenter.clone(),
            half_space: *half_space,
            friction: *friction,
            wear: *wear,
            equivalent_profile: profile,
            indentation,
            contact_radius,
            normal_force,
            amplitude: slip.amplitude,
            amplitude_by_stick: matches!(loading.amplitude, Amplitude::StickRatio(_)),
            slip_compression: slip.compression,
            stick_logarithm: slip.stick_logarithm,
            tau_per_cycle,
        })
    }

    /// The same bodies at the same indentation, moved by another amplitude, m, with the edge of stick at another compression; dimensionless time stays.
    ///
    /// # Errors
    /// As [`InitialContact::at`].
    pub fn moved_by(&self, amplitude: f64, slip_compression: f64) -> Result<Self> {
        Ok(Self { amplitude, ..self.at(self.indentation, slip_compression)? })
    }

    /// The same bodies at another indentation, with the edge of stick at another compression; amplitude and dimensionless time stay.
    ///
    /// # Arguments
    /// * `indentation` -- `d`, m, positive
    /// * `slip_compression` -- `q_c`, m, from 0; from `d` on the whole contact slides
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if a sphere would sink in to its equator, or a table end.
    pub fn at(&self, indentation: f64, slip_compression: f64) -> Result<Self> {
        let profile = &self.equivalent_profile;
        let contact_radius = profile.radius_at(indentation)?;
        let sticks = slip_compression < indentation;
        let logarithm = || stick_logarithm(profile, indentation, contact_radius, slip_compression);
        let stick_logarithm = sticks.then(logarithm).transpose()?;
        let normal_force = self.half_space.normal_stiffness() * profile.load_integral(contact_radius);
        Ok(Self {
            indentation,
            contact_radius,
            normal_force,
            slip_compression,
            stick_logarithm,
            ..self.clone()
        })
    }

    /// The same bodies at another indentation, with a core that no spring slips within: where a mesh follows an edge of stick from or to next to nothing.
    ///
    /// As [`InitialContact::at`] with the compression at the radius of the core, which may differ from the indentation by less than a double can
    /// tell.
    ///
    /// # Errors
    /// As [`InitialContact::at`].
    pub fn with_core(&self, indentation: f64, core_radius: f64) -> Result<Self> {
        let contact = self.at(indentation, indentation - self.equivalent_profile.value(core_radius))?;
        let stick_logarithm = Some((contact.contact_radius / core_radius).ln());
        Ok(Self { stick_logarithm, ..contact })
    }

    /// The contact when wear has taken all load off the slip annulus while both forces were held: deeper, with the same stick radius, which bears
    /// the whole normal force. None under full sliding.
    ///
    /// ```text
    /// F_N = 2 c_N ∫_0^c x^k (d∞ - g0) dx,    d∞ - g0(c) = q_c + (1+k) c^-(1+k) ∫_c^a0 x^k (d - g0) dx
    /// ```
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if a sphere would sink in to its equator, or a table end.
    pub fn under_held_forces(&self) -> Result<Option<Self>> {
        let (Some(logarithm), Some(stick)) = (self.stick_logarithm, self.stick_radius()) else {
            return Ok(None);
        };
        let profile = &self.equivalent_profile;
        let (grading, exponent) = (self.half_space.grading(), 1.0 + self.half_space.grading());
        let shed = if logarithm < NARROW && profile.end_of_table().is_none() {
            // In ξ = (x² - c²)/(a0² - c²), where the difference of two loads would leave few digits.
            let area = self.slip_area_offset();
            let borne = |part: f64| {
                let offset = area * part;
                let density = (stick * stick + offset).powf(0.5 * (grading - 1.0));
                density * (self.slip_compression - profile.rise(stick, offset))
            };
            0.5 * area * Rule::legendre(NODES)?.mean(borne)
        } else {
            let held = self.slip_compression * stick.powf(exponent) / exponent;
            0.5 * (self.normal_force / self.half_space.normal_stiffness() - profile.load_integral(stick))
                - held
        };
        let rise = shed * exponent / stick.powf(exponent);
        let (indentation, compression) = (self.indentation + rise, self.slip_compression + rise);
        let deeper = self.at(indentation, compression)?;
        // The edge of stick is known, and its height a small difference where the contact nearly slides.
        let stick_logarithm = match compression > 0.5 * indentation {
            true => Some((deeper.contact_radius / stick).ln()),
            false => deeper.stick_logarithm,
        };
        Ok(Some(Self { stick_logarithm, ..deeper }))
    }

    /// The unworn indenter.
    pub fn indenter(&self) -> &Indenter {
        &self.indenter
    }

    /// Spring stiffnesses.
    pub fn half_space(&self) -> &HalfSpace {
        &self.half_space
    }

    /// Friction law.
    pub fn friction(&self) -> &Coulomb {
        &self.friction
    }

    /// Wear law.
    pub fn wear(&self) -> &Archard {
        &self.wear
    }

    /// Equivalent profile `g0` of the unworn indenter.
    pub fn equivalent_profile(&self) -> &EquivalentProfile {
        &self.equivalent_profile
    }

    /// Indentation `d`, m: as given, or under the force given.
    pub fn indentation(&self) -> f64 {
        self.indentation
    }

    /// Contact radius `a0`, m, the root of `g0(a0) = d`.
    pub fn contact_radius(&self) -> f64 {
        self.contact_radius
    }

    /// Normal force `F_N`, N: as given, or by [S, Eq. (22)].
    pub fn normal_force(&self) -> f64 {
        self.normal_force
    }

    /// Mean pressure `F_N/(π a0²)`, Pa.
    pub fn mean_pressure(&self) -> f64 {
        self.normal_force / (PI * self.contact_radius * self.contact_radius)
    }

    /// Tangential stiffness of the first contact without slip, `2 c_T ∫_0^a0 x^k dx`, N/m.
    pub fn tangential_stiffness(&self) -> f64 {
        let order = 1.0 + self.half_space.grading();
        let per_length = self.half_space.stiffness_ratio() * self.half_space.normal_stiffness();
        2.0 * per_length * self.contact_radius.powf(order) / order
    }

    /// Tangential amplitude `U`, m.
    pub fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// Whether that follows from the stick radius that was asked for, so that it is the contact's own also where a rig moves it.
    pub fn amplitude_follows_stick(&self) -> bool {
        self.amplitude_by_stick
    }

    /// Tangential amplitude `μ_f d/M`, m, from which on the whole contact slides.
    pub fn amplitude_full_sliding(&self) -> f64 {
        full_sliding_amplitude(self.half_space.stiffness_ratio(), self.friction.coefficient, self.indentation)
    }

    /// Spring compression at the edge of stick, `q_c = M U/μ_f`, m; from `d` on every spring slips.
    pub fn slip_compression(&self) -> f64 {
        self.slip_compression
    }

    /// What the oscillation does to the contact.
    pub fn regime(&self) -> Regime {
        match self.stick_logarithm {
            None => Regime::FullSliding,
            Some(logarithm) if logarithm > 0.0 => Regime::PartialSlip,
            Some(_) => Regime::Stick,
        }
    }

    /// Stick radius `c`, m: the contact radius where nothing slips, none under full sliding.
    pub fn stick_radius(&self) -> Option<f64> {
        self.stick_logarithm.map(|logarithm| self.contact_radius * (-logarithm).exp())
    }

    /// `ln(a0/c)`: zero where nothing slips, none under full sliding; it keeps the digits of the smallest amplitudes.
    pub fn stick_logarithm(&self) -> Option<f64> {
        self.stick_logarithm
    }

    /// `a0² - c²`, m², to full relative accuracy; `a0²` under full sliding.
    pub fn slip_area_offset(&self) -> f64 {
        let area = self.contact_radius * self.contact_radius;
        self.stick_logarithm.map_or(area, |logarithm| area * -(-2.0 * logarithm).exp_m1())
    }

    /// Archard's law that stands for a law of wear in the closed form and the dimensionless time.
    pub fn reference_wear(&self, law: &dyn WearLaw) -> Archard {
        let radial = self.contact_radius.powf(self.half_space.grading() - 1.0);
        let scales = Scales {
            pressure: self.half_space.normal_stiffness() * (radial * self.indentation),
            path: 4.0 * self.amplitude_full_sliding(),
            friction: self.friction.coefficient,
        };
        Archard { coefficient: law.reference(&scales) }
    }

    /// Dimensionless time `τ` of one cycle.
    ///
    /// ```text
    /// τ/N = 4 k_w c_N a0^(k-1) μ_f d / M
    /// ```
    pub fn tau_per_cycle(&self) -> f64 {
        self.tau_per_cycle
    }
}

fn positive(name: &'static str, value: f64) -> Result<()> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::OutOfRange { name, value, range: "(0, inf)" })
}

/// Passes what a double holds with all its digits.
///
/// `keys` are those of the scene that decide, of which the first is shown.
fn representable(what: &str, value: f64, keys: &[&'static str]) -> Result<()> {
    if value > 0.0 && value.is_normal() {
        return Ok(());
    }
    let why = match value {
        value if value.is_nan() => "comes from numbers too large and too small",
        value if value > 1.0 => "is too large",
        _ => "is too small",
    };
    Err(Error::Inconsistent {
        what: keys[0],
        why: format!(
            "the {what} = {value:e} {why} to compute with; check the value and the unit of {}",
            keys.join(", ")
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::indenter::TabulatedProfile;
    use crate::laws::loading::{Duration, Load};

    const FRICTION: f64 = 0.6;
    const WEAR: f64 = 1e-14;

    fn contact(
        indenter: &Indenter,
        grading: f64,
        load: Load,
        amplitude: Amplitude,
    ) -> Result<InitialContact> {
        InitialContact::new(
            indenter,
            &HalfSpace::from_stiffness(grading, 1e10, 0.7)?,
            &Coulomb { coefficient: FRICTION },
            &Archard { coefficient: WEAR },
            &Loading { load, amplitude, duration: Duration::Tau(1.0) },
        )
    }

    fn indenters() -> [Indenter; 5] {
        let radius: Vec<f64> = (0..160).map(|i| 2e-6 * f64::from(i)).collect();
        let height = radius.iter().map(|r| 30.0 * r * r + 1e-1 * r).collect();
        let table = TabulatedProfile::new("rows", radius, height).unwrap();
        [
            Indenter::from(std::sync::Arc::new(table)),
            Indenter::paraboloid(0.01).unwrap(),
            Indenter::cone(0.05).unwrap(),
            Indenter::power_law(1e3, 4.0).unwrap(),
            Indenter::sphere(1e-4).unwrap(),
        ]
    }

    fn close(found: f64, expected: f64, tolerance: f64, place: &str) {
        let error = (found / expected - 1.0).abs();
        assert!(error <= tolerance, "{place}: {found:e} instead of {expected:e}, relative error {error:e}");
    }

    #[test]
    fn the_three_forms_of_the_amplitude_agree() {
        let depth = Load::Indentation(1e-6);
        for indenter in indenters() {
            for grading in [-0.9, -0.3, 0.0, 0.5, 0.95] {
                for gap in [0.9, 0.3, 1e-3, 1e-9] {
                    let place = format!("{indenter:?}, k = {grading}, c/a0 = 1 - {gap}");
                    let stick_ratio = 1.0 - gap;
                    let given =
                        contact(&indenter, grading, depth, Amplitude::StickRatio(stick_ratio)).unwrap();
                    let ratio = given.amplitude() / (FRICTION * given.indentation());
                    for other in [Amplitude::Displacement(given.amplitude()), Amplitude::Ratio(ratio)] {
                        let other = contact(&indenter, grading, depth, other).unwrap();
                        close(other.slip_compression(), given.slip_compression(), 1e-15, &place);
                        let stick = [&other, &given].map(|it| it.stick_radius().unwrap());
                        // The rounding of q_c next to d is that of g0(c) = d - q_c.
                        let tolerance =
                            1e-15 * given.indentation() / given.equivalent_profile().value(stick[1]);
                        let share = stick_ratio * stick_ratio;
                        let area_tolerance = 1e-14 + tolerance * share;
                        close(other.slip_area_offset(), given.slip_area_offset(), area_tolerance, &place);
                        close(stick[0], stick[1], tolerance, &place);
                        assert_eq!(other.regime(), Regime::PartialSlip, "{place}");
                    }
                    let (a, c) = (given.contact_radius(), given.stick_radius().unwrap());
                    close(given.slip_area_offset(), (a - c) * (a + c), 1e-15 / gap, &place);
                }
            }
        }
    }

    #[test]
    fn indentation_and_force_are_inverse_to_each_other() {
        for indenter in indenters() {
            for grading in [-0.9, -0.3, 0.0, 0.5, 0.95] {
                for depth in [1e-9, 1e-6, 2e-5] {
                    let amplitude = Amplitude::StickRatio(0.7);
                    let pressed = contact(&indenter, grading, Load::Indentation(depth), amplitude).unwrap();
                    let loaded =
                        contact(&indenter, grading, Load::InitialForce(pressed.normal_force()), amplitude)
                            .unwrap();
                    let place = format!("{indenter:?}, k = {grading}, d = {depth}");
                    close(loaded.indentation(), depth, 2e-14, &place);
                    close(loaded.contact_radius(), pressed.contact_radius(), 2e-14, &place);
                    assert_eq!(loaded.normal_force(), pressed.normal_force());
                }
            }
        }
    }

    #[test]
    fn time_per_cycle_of_a_homogeneous_paraboloid_is_that_by_hand() {
        let paraboloid = Indenter::paraboloid(0.01).unwrap();
        let found =
            contact(&paraboloid, 0.0, Load::Indentation(1e-6), Amplitude::Displacement(1e-7)).unwrap();
        // a0 = √(1e-2 · 1e-6) = 1e-4;  4 · 1e-14 · 1e10 / 1e-4 · 0.6 · 1e-6 / 0.7
        close(found.tau_per_cycle(), 2.4e-6 / 0.7, 1e-15, "tau per cycle");
        // 0.7 · 1e-7 / 0.6
        close(found.slip_compression(), 7e-7 / 6.0, 1e-15, "slip compression");
        // c² = R (d - q_c)
        close(found.slip_area_offset(), 7e-9 / 6.0, 1e-15, "slip area");
        // (4/3) c_N √R d^(3/2)
        close(found.normal_force(), 4.0 / 3.0, 1e-14, "force");
    }

    #[test]
    fn the_regimes_are_told_apart() {
        let paraboloid = Indenter::paraboloid(0.01).unwrap();
        let regime = |amplitude| contact(&paraboloid, 0.0, Load::Indentation(1e-6), amplitude).unwrap();
        for none in [Amplitude::Displacement(0.0), Amplitude::Ratio(0.0), Amplitude::StickRatio(1.0)] {
            let stick = regime(none);
            assert_eq!(stick.regime(), Regime::Stick, "{none:?}");
            assert_eq!(stick.stick_radius(), Some(stick.contact_radius()), "{none:?}");
            for zero in [stick.amplitude(), stick.slip_compression(), stick.slip_area_offset()] {
                assert_eq!(zero.to_bits(), 0, "{none:?}");
            }
        }
        for large in [Amplitude::Displacement(1e-6), Amplitude::Ratio(1.43)] {
            let sliding = regime(large);
            assert_eq!(sliding.regime(), Regime::FullSliding, "{large:?}");
            assert_eq!(sliding.stick_radius(), None, "{large:?}");
            close(sliding.slip_area_offset(), sliding.contact_radius().powi(2), 0.0, "slip area");
        }
        // Next to full sliding q_c rounds to d; the stick radius is there all the same.
        let small = regime(Amplitude::StickRatio(1e-12));
        assert_eq!(small.slip_compression(), small.indentation());
        assert_eq!(small.regime(), Regime::PartialSlip);
        close(small.stick_radius().unwrap(), 1e-12 * small.contact_radius(), 1e-14, "stick radius");
    }

    #[test]
    fn absurd_values_are_refused_by_name_and_never_give_numbers_that_are_none() {
        use Amplitude::{Displacement, Ratio, StickRatio};
        use Load::{Indentation, InitialForce};

        let paraboloid = Indenter::paraboloid(0.01).unwrap();
        let sphere = Indenter::sphere(1e-4).unwrap();
        let ratio = StickRatio(0.7);
        let cases = [
            (&paraboloid, Indentation(0.0), ratio, "loading.indentation = 0 is outside"),
            (&paraboloid, Indentation(f64::NAN), ratio, "loading.indentation = NaN is outside"),
            (&paraboloid, InitialForce(-1.0), ratio, "loading.initial_force = -1 is outside"),
            (&paraboloid, Indentation(1e308), ratio, "volume π a0² d, m³ = inf is too large"),
            (&paraboloid, Indentation(1e-308), ratio, "indentation, m = 1e-308 is too small"),
            (&paraboloid, InitialForce(1e-310), ratio, "unit of loading.initial_force, half_space"),
            (&sphere, Indentation(1e-3), ratio, "loading.indentation: 0.001 is too large: a sphere"),
            (&sphere, InitialForce(1e6), ratio, "loading.initial_force: 1000000 is too large: F_N"),
            (&paraboloid, Indentation(1e-6), StickRatio(0.0), "loading.stick_ratio = 0 is"),
            (&paraboloid, Indentation(1e-6), StickRatio(1e-320), "unit of loading.stick_ratio"),
            (&paraboloid, Indentation(1e-6), Ratio(-0.1), "loading.amplitude_ratio = -0.1 is"),
            (&paraboloid, Indentation(1e9), Ratio(1e308), "amplitude, m = inf is too large"),
            (&paraboloid, Indentation(1e-6), Displacement(1e-300), "unit of loading.amplitude"),
            (&paraboloid, Indentation(1e-6), Displacement(f64::INFINITY), "loading.amplitude ="),
        ];
        for (indenter, load, amplitude, words) in cases {
            let found = contact(indenter, 0.0, load, amplitude).map(drop).unwrap_err().to_string();
            assert!(found.contains(words), "{load:?}, {amplitude:?}: {found}");
        }
    }
}
