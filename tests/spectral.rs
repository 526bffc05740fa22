//! Plain transients against a spectral method that shares neither mesh, nor operators, nor time stepping with the program.

#[path = "support/spectral.rs"]
mod spectral;

use fretwear::scene::Scene;
use spectral::{Plain, Spectral};

/// Times `τ` of a transient, steps in a factor of ten of them, and nodes.
const TAUS: [f64; 8] = [0.1, 0.3, 1.0, 3.0, 6.0, 10.0, 30.0, 100.0];
const STEPS: f64 = 40.0;
const NODES: usize = 24;

/// Largest difference of volumes over the last one.
fn apart(volumes: &[f64], others: &[f64]) -> f64 {
    let last = others[others.len() - 1];
    volumes.iter().zip(others).map(|(a, b)| (a - b).abs() / last).fold(0.0, f64::max)
}

fn volumes(plain: Plain, nodes: usize, steps: f64, taus: &[f64]) -> Vec<f64> {
    Spectral::new(plain, nodes).run(taus, steps).into_iter().map(|[_, volume]| volume).collect()
}

/// `data/reference/plain_transients.csv`, by another code for the same method.
#[test]
fn the_spectral_method_gives_the_volumes_and_radii_of_the_table() {
    let table = include_str!("../data/reference/plain_transients.csv");
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    let rows: Vec<Vec<f64>> = table.lines().skip(1).map(row).collect();
    for transient in rows.chunk_by(|a, b| a[..3] == b[..3]) {
        let [grading, exponent, stick_ratio] = *transient[0].first_chunk().unwrap();
        let plain = Plain { grading, exponent, stick_ratio };
        let taus: Vec<f64> = transient.iter().map(|row| row[3]).collect();
        let seen = Spectral::new(plain, NODES).run(&taus, STEPS);
        let known: Vec<f64> = transient.iter().map(|row| row[4]).collect();
        let off = apart(&seen.iter().map(|it| it[1]).collect::<Vec<_>>(), &known);
        // Measured: 3e-9 to 2.8e-7, volumes, and up to 6.1e-6, radii, the most at k = 0.22.
        assert!(off < 6e-7, "{plain:?}: volumes off by {off:e}");
        for ([radius, _], row) in seen.iter().zip(transient) {
            assert!((radius - row[6]).abs() < 2e-5, "{plain:?} at τ = {}: {radius}, not {}", row[3], row[6]);
        }
    }
}

#[test]
fn the_spectral_method_converges_much_faster_than_the_springs() {
    let plain = Plain { grading: 0.0, exponent: 2.0, stick_ratio: 0.7 };
    let exact = volumes(plain, 32, 80.0, &TAUS);
    let errors = [8, 12, 16].map(|nodes| apart(&volumes(plain, nodes, STEPS, &TAUS), &exact));
    println!("errors {errors:?} in time {:e}", apart(&volumes(plain, 32, STEPS, &TAUS), &exact));
    // By boundary elements of the three-dimensional half-space, to six digits.
    for (tau, known) in [(1.0, 0.0268731), (3.0, 0.0830288), (10.0, 0.213381), (30.0, 0.235817)] {
        let at = TAUS.iter().position(|it| *it == tau).unwrap();
        assert!((exact[at] / known - 1.0).abs() < 1e-5, "τ = {tau}: {}, not {known}", exact[at]);
    }
    for (error, most) in errors.into_iter().zip([3e-4, 5e-6, 5e-7]) {
        assert!(error < most, "{errors:?}");
    }
}

/// Uniform numbers in [0, 1): xorshift64 (Marsaglia 2003).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Worn volumes of the program over `a0² d`, and what it says of their error.
fn run(plain: Plain, accuracy: f64) -> (Vec<f64>, Option<f64>) {
    let Plain { grading, exponent, stick_ratio } = plain;
    let text = format!(
        "[indenter.power-law]\ncoefficient = 1.0\nexponent = {exponent}\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1e9\n\
         stiffness_ratio = 1.0\n[friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = 1e-14\n[loading]\nindentation = 1e-6\n\
         stick_ratio = {stick_ratio}\ntau = 100\n[output]\nat_tau = {TAUS:?}\n[numerics]\naccuracy = {accuracy:e}\n"
    );
    let results = Scene::from_toml(&text, "plain.toml").unwrap().simulate().unwrap();
    let scale = results.contact_radius()[0].powi(2) * 1e-6;
    (results.worn_volume()[1..].iter().map(|volume| volume / scale).collect(), results.error_estimate())
}

#[test]
fn twenty_transients_drawn_at_random_are_as_accurate_as_asked() {
    let mut random = Random(0x5_eed0_f7a6);
    for _ in 0..20 {
        random.next();
    }
    let mut worst = [0.0_f64; 3];
    for _ in 0..20 {
        let plain = Plain {
            grading: -0.5 + 1.4 * random.next(),
            exponent: 1.0 + 3.0 * random.next(),
            stick_ratio: 0.3 + 0.65 * random.next(),
        };
        let exact = volumes(plain, NODES, STEPS, &TAUS);
        for (accuracy, worst) in [1e-3, 1e-4, 1e-6].into_iter().zip(&mut worst) {
            let (worn, estimate) = run(plain, accuracy);
            let off = apart(&worn, &exact) / accuracy;
            assert!(off <= 1.0, "{plain:?} at {accuracy:e}: off by {off:.2} of it, estimate {estimate:?}");
            *worst = worst.max(off);
        }
        println!("{plain:?}: {worst:.2?}");
    }
}
