//! Edges of stick that recede under friction that depends on the load, in media whose modulus falls with depth: the layer in which ground that was passed wears gets thinner than any
//! mesh.

use fretwear::Results;
use fretwear::scene::Scene;

/// What is pressed on, and at what part of the amplitude of gross slip.
const SHAPES: [&str; 3] = [
    "[indenter.paraboloid]\nradius = \"10 mm\"",
    "[indenter.cone]\nslope = 0.01",
    "[indenter.power-law]\ncoefficient = 5e5\nexponent = 3",
];

/// A held tangential force.
const FORCE: &str = "tangential_control = \"force\"";

struct Receding<'a> {
    shape: &'a str,
    grading: f64,
    /// Exponent of the friction coefficient by the load.
    exponent: f64,
    ratio: f64,
    wear: &'a str,
    control: &'a str,
    history: &'a str,
    tau: f64,
}

const PARABOLOID: Receding = Receding {
    shape: SHAPES[0],
    grading: -0.5,
    exponent: -0.3,
    ratio: 0.6,
    wear: "archard",
    control: FORCE,
    history: "",
    tau: 20.0,
};

impl Receding<'_> {
    fn run(&self, numerics: &str) -> Results {
        let Receding { shape, grading, exponent, ratio, wear, control, history, tau } = self;
        let text = format!(
            "{shape}\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1e11\nstiffness_ratio = 0.8\n\
             [friction.load-dependent]\ncoefficient = 0.5\nexponent = {exponent}\n{history}\n\
             [wear.{wear}]\ncoefficient = 1e-13\n\
             [loading]\nindentation = \"1 um\"\namplitude_ratio = {ratio}\n{control}\ntau = {tau}\n\
             [numerics]\n{numerics}\n[output]\nsnapshots = 5\n"
        );
        let scene: Scene = text.parse().unwrap_or_else(|error| panic!("{error}\n{text}"));
        scene.simulate().unwrap_or_else(|error| panic!("{error}\n{text}"))
    }
}

fn volume(results: &Results) -> f64 {
    results.last().wear_volume
}

/// Without the straight line next to the edge no step led on, on 50 and on 100 springs.
#[test]
fn the_volume_converges_over_the_springs() {
    for (exponent, ratio, wear) in
        [(-0.3, 0.6, "archard"), (-0.3, 0.75, "archard"), (-0.3, 0.6, "dissipated-energy")]
    {
        let scene = Receding { exponent, ratio, wear, ..PARABOLOID };
        let on = |springs: usize| volume(&scene.run(&format!("accuracy = 1e-3\nsprings = {springs}")));
        let finest = on(200);
        let off = [50, 100].map(|springs| on(springs) / finest - 1.0);
        println!("{exponent} {ratio} {wear}: {off:?}");
        assert!(off[0].abs() < 1.2e-3 && off[1].abs() < 4e-4, "{exponent} {ratio} {wear}: {off:?}");
    }
}

/// It recedes to the limit of the last edge, whatever the law of wear.
#[test]
fn it_ends_at_the_limit_of_the_last_edge() {
    for wear in ["archard", "dissipated-energy"] {
        for grading in [-0.5, -0.2] {
            let results = Receding { grading, wear, tau: 300.0, ..PARABOLOID }.run("accuracy = 1e-3");
            let limit = results.limit().expect("a limit").wear_volume();
            let off = volume(&results) / limit - 1.0;
            println!("{wear}, k = {grading}: {off:e}");
            assert!(off.abs() < 1e-5, "{wear}, k = {grading}: {off:e}");
        }
    }
}

/// Accuracy asked is accuracy delivered, without a word by hand.
#[test]
fn the_program_finds_springs_that_serve() {
    let scenes = [
        (SHAPES[0], -0.5, -0.2, 0.75),
        (SHAPES[1], -0.5, -0.3, 0.4),
        (SHAPES[2], -0.5, -0.2, 0.75),
        (SHAPES[2], -0.3, -0.3, 0.6),
        (SHAPES[0], -0.3, 0.2, 0.6),
    ];
    for (shape, grading, exponent, ratio) in scenes {
        let scene = Receding { shape, grading, exponent, ratio, ..PARABOLOID };
        let results = scene.run("accuracy = 1e-3");
        let off = volume(&results) / volume(&scene.run("accuracy = 1e-3\nsprings = 200")) - 1.0;
        println!("k = {grading}, {exponent}, {ratio}: {:?}, off {off:e}", results.error_estimate());
        assert_eq!(results.accuracy_met(), Some(true), "k = {grading}, {exponent}, {ratio}");
        assert!(off.abs() < 1e-3, "k = {grading}, {exponent}, {ratio}: {off:e}");
    }
}

/// So it does where friction that falls drives the edge inwards.
#[test]
fn falling_friction_is_followed_to_its_limit() {
    for (final_factor, tau) in [(0.7, 0.3), (0.7, 3.0), (0.9, 0.3)] {
        let history = format!("[friction.history]\nfinal_factor = {final_factor}\ntau = {tau}");
        let scene = Receding { grading: -0.7, control: "", history: &history, tau: 300.0, ..PARABOLOID };
        let results = scene.run("accuracy = 1e-3");
        let off = volume(&results) / results.limit().expect("a limit").wear_volume() - 1.0;
        println!("{final_factor}, {tau}: {off:e}");
        assert!(results.accuracy_met() == Some(true) && off.abs() < 1e-4, "{final_factor}, {tau}: {off:e}");
    }
}

/// Traction that falls with a small power of the load wears springs to zero in a finite time; steps used to get ever smaller from there on, at k = -0.3 from τ = 8 on.
#[test]
fn wear_that_is_over_in_a_finite_time_ends_at_the_limit() {
    for (grading, exponent) in [(-0.3, -0.2), (-0.3, -0.5), (0.0, -0.3), (0.5, -0.2)] {
        let scene =
            Receding { grading, exponent, wear: "dissipated-energy", control: "", tau: 100.0, ..PARABOLOID };
        let results = scene.run("accuracy = 1e-4");
        let last = results.last();
        let off = last.wear_volume / results.limit().expect("a limit").wear_volume() - 1.0;
        let balance = last.wear_volume / (1e-13 * last.dissipated_energy) - 1.0;
        println!("k = {grading}, {exponent}: off {off:e}, V/(α ΣE) - 1 = {balance:e}");
        assert_eq!(results.accuracy_met(), Some(true), "k = {grading}, {exponent}");
        assert!(off.abs() < 1e-6, "k = {grading}, {exponent}: {off:e}");
        assert!(balance.abs() < 1e-4, "k = {grading}, {exponent}: {balance:e}");
    }
}
