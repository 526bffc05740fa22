//! The kinds of scenes and the extremes to which each is taken.

use std::collections::BTreeMap;

/// A contact by its sizes; every kind is given by them, so that it means the same in other units and media.
#[derive(Clone)]
struct Sizes {
    grading: f64,
    exponent: f64,
    /// Compression at the edge of stick over the indentation.
    severity: f64,
    /// Contact radius, m, about.
    radius: f64,
    depth: f64,
    /// Normal stiffness c_N.
    stiffness: f64,
    cycles: f64,
    tau: f64,
}

/// Tangential over normal stiffness, and the coefficient of friction.
const STIFFNESS_RATIO: f64 = 0.8;
const FRICTION: f64 = 0.5;

impl Sizes {
    fn pressure(&self) -> f64 {
        self.stiffness * self.radius.powf(self.grading - 1.0) * self.depth
    }

    /// Normal force of the unworn contact, about.
    fn force(&self) -> f64 {
        // 2 c_N ∫ x^k (d - g) dx
        let power = 1.0 + self.grading;
        2.0 * self.stiffness * self.radius.powf(power) * self.depth * self.exponent
            / (power * (self.exponent + power))
    }

    /// Tangential stiffness of the whole contact.
    fn tangential(&self) -> f64 {
        let power = 1.0 + self.grading;
        2.0 * STIFFNESS_RATIO * self.stiffness * self.radius.powf(power) / power
    }

    /// `q_c/μ_f`: slip of the free contact edge, m.
    fn slip(&self) -> f64 {
        FRICTION * self.depth / STIFFNESS_RATIO
    }

    /// Coefficient of Archard's law with which the cycles come to τ.
    fn wear(&self) -> f64 {
        self.tau / self.cycles / (4.0 * self.pressure() * self.slip() / self.depth)
    }
}

/// A kind of scene: its lines by place.
type Kind = (&'static str, fn(&Sizes) -> Vec<(&'static str, String)>);

const KINDS: [Kind; 28] = [
    ("plain", |_| vec![]),
    ("dissipated energy", |it| {
        vec![("wear", format!("[wear.dissipated-energy]\ncoefficient = {:e}", it.wear() / FRICTION))]
    }),
    ("p^1.5 s", |it| power(it, 1.5, 1.0)),
    ("p^0.7 s^0.8", |it| power(it, 0.7, 0.8)),
    ("p s^2", |it| power(it, 1.0, 2.0)),
    ("threshold", |it| {
        let pressure = 0.1 * it.pressure();
        vec![("wear", format!("[wear.threshold]\ncoefficient = {:e}\npressure = {pressure:e}", it.wear()))]
    }),
    ("non-local", |it| {
        let length = 0.05 * it.radius;
        vec![("wear", format!("[wear.non-local]\ncoefficient = {:e}\nlength = {length:e}", it.wear()))]
    }),
    ("friction power", |it| {
        let power = it.pressure() * 4.0 * FRICTION * it.slip();
        let (frequency, coefficient) = ("frequency = 1.0".into(), it.wear() / FRICTION);
        let law = format!(
            "[wear.friction-power]\nscope = \"local\"\ncoefficient = {coefficient:e}\nexponent = -0.25\nreference_power = {power:e}"
        );
        vec![("wear", law), ("frequency", frequency)]
    }),
    ("wear that falls", |it| {
        vec![("wear history", format!("[wear.history]\nfinal_factor = 0.3\ntau = {:e}", 0.3 * it.tau))]
    }),
    ("static and kinetic", |_| {
        let law = "[friction.static-kinetic]\nstatic_coefficient = 0.5\nkinetic_coefficient = 0.4";
        vec![("friction", law.into())]
    }),
    ("load-dependent", |_| {
        vec![("friction", format!("[friction.load-dependent]\ncoefficient = {FRICTION}\nexponent = -0.2"))]
    }),
    ("wear-dependent", |it| {
        let density = 0.3 * it.tau * it.pressure() * it.slip() / it.wear() * it.wear();
        let law = "first_coefficient = 0.5\nlast_coefficient = 0.6";
        vec![("friction", format!("[friction.wear-dependent]\n{law}\nenergy_density = {density:e}"))]
    }),
    ("falling friction", |it| factor("friction history", "friction", 0.8, it)),
    ("rising friction", |it| factor("friction history", "friction", 1.2, it)),
    ("normal force held", |it| vec![("load", format!("normal_force = {:e}", it.force()))]),
    ("tangential force held", |_| vec![("control", "tangential_control = \"force\"".into())]),
    ("both forces held", |it| {
        vec![
            ("load", format!("normal_force = {:e}", it.force())),
            ("control", "tangential_control = \"force\"".into()),
        ]
    }),
    ("rig", |it| vec![("control", format!("rig_stiffness = {:e}", 2.0 * it.tangential()))]),
    ("normal oscillation", |_| {
        let table = "amplitude_ratio = 0.1\nfrequency_ratio = 1\nphase = 1";
        vec![("mode", format!("[loading.normal_oscillation]\n{table}"))]
    }),
    ("orbit", |_| vec![("mode", "[loading.orbit]\ntransverse_ratio = 0.6".into())]),
    ("circle", |_| vec![("mode", "[loading.orbit]\ntransverse_ratio = 1".into())]),
    ("diagonal", |_| vec![("mode", "[loading.orbit]\ntransverse_ratio = 1\nphase = \"90 deg\"".into())]),
    ("growing blocks", |it| blocks(it, &[(0.3, 0.7, 1.0), (1.0, 1.0, 1.0)], false)),
    ("shrinking blocks", |it| blocks(it, &[(0.3, 1.0, 1.0), (1.0, 0.7, 1.0)], false)),
    ("repeated blocks", |it| blocks(it, &[(0.1, 1.0, 1.0), (0.1, 0.7, 1.0)], true)),
    ("deeper blocks, repeated", |it| blocks(it, &[(0.2, 1.0, 1.0), (0.2, 1.0, 1.2)], true)),
    ("first cycle counted", |_| vec![("start", "wear_from = \"first-cycle\"".into())]),
    ("until a rate", |_| vec![("end", "until_rate = 1e-8".into())]),
];

fn power(it: &Sizes, by_pressure: f64, by_slip: f64) -> Vec<(&'static str, String)> {
    let slip = 4.0 * it.slip();
    let coefficient = it.wear() * it.pressure().powf(1.0 - by_pressure) * slip.powf(1.0 - by_slip);
    let exponents = format!("pressure_exponent = {by_pressure}\nslip_exponent = {by_slip}");
    vec![("wear", format!("[wear.power-law]\ncoefficient = {coefficient:e}\n{exponents}"))]
}

fn factor(place: &'static str, law: &str, last: f64, it: &Sizes) -> Vec<(&'static str, String)> {
    vec![(place, format!("[{law}.history]\nfinal_factor = {last}\ntau = {:e}", 0.3 * it.tau))]
}

fn blocks(it: &Sizes, of: &[(f64, f64, f64)], repeat: bool) -> Vec<(&'static str, String)> {
    let block = |(part, amplitude, depth): &(f64, f64, f64)| {
        let tau = part * it.tau;
        format!(
            "[[loading.blocks]]\ntau = {tau:e}\namplitude_factor = {amplitude}\nindentation_factor = {depth}\n"
        )
    };
    let tables: String = of.iter().map(block).collect();
    vec![("mode", tables), ("repeat", if repeat { "repeat = true".into() } else { String::new() })]
}

/// An extreme: what of the sizes is taken there.
type Extreme = (&'static str, fn(&mut Sizes));

const EXTREMES: [Extreme; 22] = [
    ("usual", |_| {}),
    ("k = 0.9999", |it| it.grading = 0.9999),
    ("k = 0.99", |it| it.grading = 0.99),
    ("k = -0.99", |it| it.grading = -0.99),
    ("k = -0.9999", |it| it.grading = -0.9999),
    ("amplitude 1e-10", |it| it.severity = 1e-10),
    ("amplitude 1e-4", |it| it.severity = 1e-4),
    ("amplitude 1 - 1e-2", |it| it.severity = 1.0 - 1e-2),
    ("amplitude 1 - 1e-6", |it| it.severity = 1.0 - 1e-6),
    ("amplitude 1 + 1e-6", |it| it.severity = 1.0 + 1e-6),
    ("amplitude 3", |it| it.severity = 3.0),
    ("amplitude 100", |it| it.severity = 100.0),
    ("n = 0.1", |it| it.exponent = 0.1),
    ("n = 20", |it| it.exponent = 20.0),
    ("nm", |it| (it.radius, it.depth) = (1e-9, 1e-11)),
    ("km", |it| (it.radius, it.depth) = (1e3, 1e1)),
    ("1e12 cycles", |it| (it.cycles, it.tau) = (1e12, 30.0)),
    ("1e-15 of wear a cycle", |it| (it.cycles, it.tau) = (1e3, 1e-12)),
    ("one cycle to the limit", |it| (it.cycles, it.tau) = (1.0, 30.0)),
    ("τ = 1e6", |it| it.tau = 1e6),
    ("k = 0.9999, n = 20, amplitude 1 - 1e-6", |it| {
        (it.grading, it.exponent, it.severity) = (0.9999, 20.0, 1.0 - 1e-6);
    }),
    ("k = -0.9999, n = 0.1, amplitude 1e-10", |it| {
        (it.grading, it.exponent, it.severity) = (-0.9999, 0.1, 1e-10);
    }),
];

fn text(sizes: &Sizes, kind: &Kind) -> String {
    let ratio = sizes.severity / STIFFNESS_RATIO;
    let coefficient = sizes.depth / sizes.radius.powf(sizes.exponent);
    let mut lines = BTreeMap::from([
        ("load", format!("indentation = {:e}", sizes.depth)),
        ("wear", format!("[wear.archard]\ncoefficient = {:e}", sizes.wear())),
        ("friction", format!("[friction.coulomb]\ncoefficient = {FRICTION}")),
        ("end", format!("cycles = {:e}", sizes.cycles)),
    ]);
    lines.extend(kind.1(sizes));
    let line = |name: &str| lines.get(name).cloned().unwrap_or_default();
    let mut text = format!(
        "[indenter.power-law]\ncoefficient = {coefficient:e}\nexponent = {}\n[half_space]\ngrading = {}\nnormal_stiffness = {:e}\nstiffness_ratio = {STIFFNESS_RATIO}\n",
        sizes.exponent, sizes.grading, sizes.stiffness
    );
    for name in ["friction", "friction history", "wear", "wear history"] {
        text += &(line(name) + "\n");
    }
    text += &format!("[loading]\namplitude_ratio = {ratio:?}\n");
    for name in ["load", "end", "control", "frequency", "repeat", "start", "mode"] {
        text += &(line(name) + "\n");
    }
    text + "[numerics]\naccuracy = 1e-2\n[output]\nsnapshots = 6\n"
}

/// Kind and extreme, and their scene.
pub fn cells() -> BTreeMap<String, String> {
    let usual = Sizes {
        grading: 0.0,
        exponent: 2.0,
        severity: 0.5,
        radius: 1e-3,
        depth: 1e-6,
        stiffness: 1e11,
        cycles: 1e5,
        tau: 3.0,
    };
    let mut cells = BTreeMap::new();
    for kind in &KINDS {
        for (name, takes) in EXTREMES {
            let mut sizes = usual.clone();
            takes(&mut sizes);
            cells.insert(format!("{} at {name}", kind.0), text(&sizes, kind));
        }
    }
    cells
}

/// Names of the kinds, and of the extremes.
pub fn names() -> [Vec<&'static str>; 2] {
    [KINDS.iter().map(|it| it.0).collect(), EXTREMES.iter().map(|it| it.0).collect()]
}
