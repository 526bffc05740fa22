//! Wear from the first loading on: a quarter of a settled cycle more, under every control, law and regime.

use fretwear::Scene;
use fretwear::run::Results;

/// Tables and lines of a scene in units of the first contact, `cycles` of which make `τ`.
struct Case {
    friction: &'static str,
    /// `{k}` stands for the coefficient that makes `τ/N` one under Archard's law.
    wear: &'static str,
    loading: &'static str,
}

const COULOMB: &str = "[friction.coulomb]\ncoefficient = 1.0";
const ARCHARD: &str = "[wear.archard]\ncoefficient = {k}";
const PARTIAL: &str = "indentation = 1.0\nstick_ratio = 0.7";
const fn case(friction: &'static str, wear: &'static str, loading: &'static str) -> Case {
    Case { friction, wear, loading }
}

/// First radius and indentation, stiffnesses and friction one; `F_N = 4/3`.
const CASES: [Case; 14] = [
    case(COULOMB, ARCHARD, PARTIAL),
    case(COULOMB, ARCHARD, "indentation = 1.0\namplitude_ratio = 2.0"),
    case(COULOMB, ARCHARD, "normal_force = 1.3333333333333333\namplitude_ratio = 2.0"),
    case(COULOMB, ARCHARD, "normal_force = 1.3333333333333333\nstick_ratio = 0.7"),
    case(COULOMB, ARCHARD, "indentation = 1.0\nstick_ratio = 0.8\ntangential_control = \"force\""),
    case(
        COULOMB,
        ARCHARD,
        "normal_force = 1.3333333333333333\nstick_ratio = 0.7\ntangential_control = \"force\"",
    ),
    case(COULOMB, ARCHARD, "indentation = 1.0\nstick_ratio = 0.8\nrig_stiffness = 2.0"),
    case(COULOMB, "[wear.dissipated-energy]\ncoefficient = {k}", PARTIAL),
    case(
        COULOMB,
        "[wear.power-law]\ncoefficient = {k}\npressure_exponent = 1.5\nslip_exponent = 0.8",
        PARTIAL,
    ),
    case(COULOMB, "[wear.threshold]\ncoefficient = {k}\npressure = 0.1", PARTIAL),
    case(
        COULOMB,
        "[wear.friction-power]\ncoefficient = {k}\nexponent = -0.25\nscope = \"local\"",
        "indentation = 1.0\nstick_ratio = 0.7\nfrequency = 10",
    ),
    case(
        COULOMB,
        "[wear.friction-power]\ncoefficient = {k}\nexponent = -0.25\nscope = \"global\"",
        "indentation = 1.0\nstick_ratio = 0.7\nfrequency = 10",
    ),
    case("[friction.static-kinetic]\nstatic_coefficient = 1.2\nkinetic_coefficient = 1.0", ARCHARD, PARTIAL),
    case("[friction.load-dependent]\ncoefficient = 1.0\nexponent = -0.2", ARCHARD, PARTIAL),
];

impl Case {
    /// Worn for some cycles of a dimensionless time each.
    fn run(&self, tau_per_cycle: f64, cycles: f64, from: &str) -> Results {
        self.scene(tau_per_cycle, cycles, from).simulate().unwrap()
    }

    fn scene(&self, tau_per_cycle: f64, cycles: f64, from: &str) -> Scene {
        let wear = self.wear.replace("{k}", &format!("{:e}", 0.25 * tau_per_cycle));
        let text = format!(
            "[indenter.paraboloid]\nradius = 1.0\n[half_space]\ngrading = 0\nnormal_stiffness = 1.0\nstiffness_ratio = 1.0\n{}\n{wear}\n\
             [loading]\n{}\nwear_from = \"{from}\"\ncycles = {cycles:e}\n[numerics]\naccuracy = 1e-5\n[output]\nsnapshots = 2\n",
            self.friction, self.loading
        );
        text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
    }
}

fn relative(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

#[test]
fn a_run_from_rest_is_the_settled_one_a_quarter_of_a_cycle_further() {
    for case in &CASES {
        let tau_per_cycle = if case.wear.contains("friction-power") { 5e-3 } else { 0.05 };
        let [from_rest, further, settled] = [("first-cycle", 10.0), ("settled", 10.25), ("settled", 10.0)]
            .map(|(from, cycles)| case.run(tau_per_cycle, cycles, from));
        let (one, other) = (from_rest.last(), further.last());
        let volume = relative(one.wear_volume, other.wear_volume);
        let energy = relative(one.dissipated_energy, other.dissipated_energy);
        let apart = relative(settled.last().wear_volume, other.wear_volume);
        println!(
            "{} {} {}: {volume:.1e}, {energy:.1e}; settled {apart:.1e}",
            case.friction, case.wear, case.loading
        );
        assert!(volume < 5e-5 && energy < 5e-5, "{} {}: {volume:e}, {energy:e}", case.wear, case.loading);
        assert!(apart > 20.0 * volume, "{} {}: {apart:e} {volume:e}", case.wear, case.loading);
        assert!(from_rest.wear_depth()[0].iter().all(|depth| *depth == 0.0));
        // The loop is that of the settled cycle, and not 5/4 of it.
        assert!(relative(from_rest.energy_ratio()[0], settled.energy_ratio()[0]) < 1e-3, "{}", case.loading);
    }
}

#[test]
fn the_first_loading_wears_a_quarter_of_what_the_unworn_cycle_does() {
    // V = (k_w/μ_f) W/4, and W = 4 A Q* U by the closed form of the unworn loop.
    let (case, tau_per_cycle) = (&CASES[0], 1e-6);
    let contact = case.scene(tau_per_cycle, 1.0, "settled").contact().unwrap();
    let slipping = 1.0 - 0.7_f64.powi(2);
    let force = 4.0 / 3.0 * (1.0 - (1.0 - slipping).powf(1.5));
    let loading = 0.25 * tau_per_cycle * contact.energy_ratio().unwrap() * force * slipping;
    let [from_rest, settled] =
        ["first-cycle", "settled"].map(|from| case.run(tau_per_cycle, 1.0, from).last().wear_volume);
    assert!(relative(settled, 4.0 * loading) < 1e-4, "{settled:e}, {loading:e}");
    assert!(relative(from_rest - settled, loading) < 1e-3, "{:e}, {loading:e}", from_rest - settled);
}

#[test]
fn what_the_start_changes_is_in_proportion_to_the_wear_of_a_cycle() {
    let differences = [0.04, 0.02, 0.01].map(|tau_per_cycle| {
        let cycles = 0.4 / tau_per_cycle;
        let [from_rest, settled] = ["first-cycle", "settled"]
            .map(|from| CASES[0].run(tau_per_cycle, cycles, from).last().wear_volume);
        from_rest / settled - 1.0
    });
    let orders = [0, 1].map(|i| (differences[i] / differences[i + 1]).log2());
    assert!(orders.iter().all(|order| (order - 1.0).abs() < 0.02), "{differences:?}: orders {orders:?}");
}

#[test]
fn paths_that_settle_over_several_cycles_are_refused() {
    let text = include_str!("../data/scenes/orbit.toml")
        .replace("[loading]", "[loading]\nwear_from = \"first-cycle\"");
    let error = text.parse::<Scene>().unwrap_err().to_string();
    assert!(
        error.contains("loading.orbit") && error.contains("wear_from") && error.contains("leave that out"),
        "{error}"
    );
}
