//! Whether `numerics.accuracy` gives what is asked for: random scenes against a converged reference.
//!
//! `cargo bench --bench accuracy_asked -- 200` prints the tables of docs/accuracy.md for so many scenes (default 200) of a fixed seed, asked for 1e-2,
//! 1e-3 and 1e-4; with `fine` as well, for 1e-6, which takes longer: how often the
//! actual error is within the asked one, how often the estimate is within a factor of five of it, and the misses. Errors are the largest
//! over all snapshots, of the worn volume relative to the limit's or of the profile at any radius of the run relative to the limit's
//! largest depth. A second number is the seed.

use std::time::Instant;

use fretwear::Results;
use fretwear::error::Result;
use fretwear::laws::conditions::Conditions;
use fretwear::numerics::grid::Clustering;
use fretwear::scene::Scene;
use fretwear::solver::model::{Model, State};
use fretwear::solver::simulation::{End, Observer, Plan, Simulation};
use fretwear::solver::stepper::Bdf;

/// What is asked for, springs and tolerance of the reference, and those with which the reference is itself judged.
const COARSE: Plans = Plans { accuracies: &[1e-2, 1e-3, 1e-4], reference: (160, 2e-8), second: (112, 6e-8) };
const FINE: Plans = Plans { accuracies: &[1e-6], reference: (240, 1e-8), second: (170, 3e-8) };

/// The same where the profile converges slowly: for gradings above the number, and indenters steeper than the exponent.
const SLOW: (f64, f64) = (0.6, 6.0);
const FINE_AND_SLOW: Plans = Plans { reference: (480, 1e-8), second: (340, 3e-8), ..FINE };

struct Plans {
    accuracies: &'static [f64],
    reference: (usize, f64),
    second: (usize, f64),
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

/// A scene: grading, exponent of the indenter, stick ratio, dimensionless time at the end.
#[derive(Debug, Clone, Copy)]
struct Case {
    grading: f64,
    exponent: f64,
    stick_ratio: f64,
    tau: f64,
}

impl Case {
    fn random(random: &mut Random) -> Self {
        Self {
            grading: -0.9 + 1.85 * random.next(),
            exponent: 0.5 * 16f64.powf(random.next()),
            stick_ratio: 0.05 + 0.92 * random.next(),
            tau: 0.3 * 300f64.powf(random.next()),
        }
    }

    fn text(&self, numerics: &str) -> String {
        format!(
            "[indenter.power-law]\ncoefficient = 1.0\nexponent = {}\n[half_space]\ngrading = {}\nnormal_stiffness = 1e9\nstiffness_ratio = 1.0\n\
             [friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = 1e-14\n[loading]\nindentation = 1e-6\nstick_ratio = {}\n\
             tau = {}\n[numerics]\n{numerics}\n",
            self.exponent, self.grading, self.stick_ratio, self.tau
        )
    }

    fn scene(&self, numerics: &str) -> Result<Scene> {
        Scene::from_toml(&self.text(numerics), "case.toml")
    }
}

/// A run of which every depth at the outputs can be asked for.
struct Reference {
    model: Model,
    states: Vec<State>,
}

#[derive(Default)]
struct Seen(Vec<State>);

impl Observer for Seen {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        self.0.push(simulation.state().clone());
        Ok(())
    }
}

impl Reference {
    fn new(case: &Case, (springs, tolerance): (usize, f64), cycles: &[f64]) -> Result<Self> {
        let contact = case.scene("")?.contact()?;
        let model = Model::new(
            &contact,
            &Conditions::plain(*contact.friction(), *contact.wear()),
            springs,
            Clustering::Smooth,
        )?;
        let plan = Plan { outputs: cycles.to_vec(), end: End::Cycles(cycles[cycles.len() - 1]) };
        let mut seen = Seen::default();
        let mut simulation = Simulation::new(model, Box::new(Bdf::new(tolerance)), tolerance, plan)?;
        simulation.run(&mut [&mut seen])?;
        Ok(Self { model: simulation.into_model(), states: seen.0 })
    }

    /// Largest errors of volume and depth, and where the latter is: the part of the annulus, the part of the time.
    fn errors(&self, radii: &[f64], volumes_and_depths: &[(f64, Vec<f64>)]) -> (f64, f64, [f64; 2]) {
        let stick_area = self.model.contact().stick_radius().expect("partial slip").powi(2);
        let (mut volume, mut depth, mut place) = (0.0_f64, 0.0_f64, [0.0; 2]);
        let end = self.states[self.states.len() - 1].cycles;
        for (state, (worn, depths)) in self.states[1..].iter().zip(volumes_and_depths) {
            let fields = self.model.fields(state);
            volume = volume.max((self.model.wear_volume(&fields) - worn).abs() / self.model.limit_volume());
            for (r, w) in radii.iter().zip(depths) {
                let exact = self.model.wear_depth_at(state, &fields, r * r - stick_area);
                let off = (w - exact).abs() / self.model.depth_scale();
                if off > depth {
                    (depth, place) = (
                        off,
                        [(r * r - stick_area) / self.model.unworn().limit_slip_area(), state.cycles / end],
                    );
                }
            }
        }
        (volume, depth, place)
    }

    /// What another reference shows at its own radii.
    fn shown(&self) -> Vec<(f64, Vec<f64>)> {
        let shown = |state: &State| {
            let fields = self.model.fields(state);
            let depth = |offset: &f64| self.model.wear_depth_at(state, &fields, *offset);
            (self.model.wear_volume(&fields), self.model.offsets().iter().map(depth).collect())
        };
        self.states[1..].iter().map(shown).collect()
    }
}

fn shown(results: &Results) -> Vec<(f64, Vec<f64>)> {
    results.snapshots()[1..].iter().map(|it| (it.wear_volume, it.wear_depth.clone())).collect()
}

struct Row {
    case: Case,
    accuracy: f64,
    springs: usize,
    steps: u64,
    milliseconds: f64,
    volume: f64,
    depth: f64,
    place: [f64; 2],
    estimate: f64,
    uncertainty: f64,
}

fn judge(case: &Case, plans: &Plans) -> Result<Vec<Row>> {
    let mut rows = vec![];
    let mut references: Option<(Reference, f64)> = None;
    for &accuracy in plans.accuracies {
        let scene = case.scene(&format!("accuracy = {accuracy:e}"))?;
        let begun = Instant::now();
        let results = scene.simulate()?;
        let milliseconds = 1e3 * begun.elapsed().as_secs_f64();
        if references.is_none() {
            let cycles: Vec<f64> = results.snapshots()[1..].iter().map(|it| it.cycles).collect();
            let reference = Reference::new(case, plans.reference, &cycles)?;
            let second = Reference::new(case, plans.second, &cycles)?;
            let off = reference.errors(&second.model.radii(), &second.shown());
            references = Some((reference, off.0.max(off.1)));
        }
        let (reference, uncertainty) = references.as_ref().expect("made above");
        let (volume, depth, place) = reference.errors(results.radius(), &shown(&results));
        rows.push(Row {
            case: *case,
            accuracy,
            springs: results.springs(),
            steps: results.steps(),
            milliseconds,
            volume,
            depth,
            place,
            estimate: results.error_estimate().unwrap_or(f64::NAN),
            uncertainty: *uncertainty,
        });
    }
    Ok(rows)
}

fn main() {
    let numbers: Vec<u64> = std::env::args().filter_map(|it| it.parse().ok()).collect();
    let (count, seed) = (numbers.first().copied().unwrap_or(200), numbers.get(1).copied().unwrap_or(2019));
    let fine = std::env::args().any(|it| it == "fine");
    let plans_of = |case: &Case| match (fine, case.grading > SLOW.0 || case.exponent > SLOW.1) {
        (true, true) => FINE_AND_SLOW,
        (true, false) => FINE,
        (false, _) => COARSE,
    };
    let mut random = Random(seed);
    for _ in 0..20 {
        random.next();
    }
    let mut rows = vec![];
    for _ in 0..count {
        let case = Case::random(&mut random);
        let begun = Instant::now();
        match judge(&case, &plans_of(&case)) {
            Ok(found) => rows.extend(found),
            Err(error) => println!("{case:?}: {error}"),
        }
        if begun.elapsed().as_secs_f64() > 10.0 {
            eprintln!("{case:?}: {:.0} s", begun.elapsed().as_secs_f64());
        }
    }
    println!(
        "| asked | runs | within | estimate within 5 | error/asked: median, 90 %, 98 % | error/estimate: 5 %, median, 95 % | springs | steps | ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for &accuracy in if fine { FINE.accuracies } else { COARSE.accuracies } {
        let of: Vec<&Row> = rows.iter().filter(|row| row.accuracy == accuracy).collect();
        let error = |row: &Row| row.volume.max(row.depth);
        let share =
            |is: &dyn Fn(&Row) -> bool| of.iter().filter(|row| is(row)).count() as f64 / of.len() as f64;
        let quantile = |value: &dyn Fn(&Row) -> f64, part: f64| {
            let mut all: Vec<f64> = of.iter().map(|row| value(row)).collect();
            all.sort_by(f64::total_cmp);
            all[((all.len() - 1) as f64 * part).round() as usize]
        };
        let used = |row: &Row| error(row) / accuracy;
        let told = |row: &Row| error(row) / row.estimate;
        println!(
            "| {accuracy:e} | {} | {:.1} % | {:.1} % | {:.2}, {:.2}, {:.2} | {:.2}, {:.2}, {:.2} | {} | {} | {:.1} |",
            of.len(),
            100.0 * share(&|row| error(row) <= accuracy),
            100.0 * share(&|row| (0.2..=5.0).contains(&told(row))),
            quantile(&used, 0.5),
            quantile(&used, 0.9),
            quantile(&used, 0.98),
            quantile(&told, 0.05),
            quantile(&told, 0.5),
            quantile(&told, 0.95),
            quantile(&|row| row.springs as f64, 0.5),
            quantile(&|row| row.steps as f64, 0.5),
            quantile(&|row| row.milliseconds, 0.5),
        );
    }
    println!("\nMisses, and estimates off by more than a factor of five:\n");
    println!(
        "| k | n | c/a0 | τ | asked | volume | depth | at, part of annulus | of time | estimate | springs | reference ± |\n|---|---|---|---|---|---|---|---|---|---|---|---|"
    );
    for row in &rows {
        let error = row.volume.max(row.depth);
        if error > row.accuracy || !(0.2..=5.0).contains(&(error / row.estimate)) {
            let Case { grading, exponent, stick_ratio, tau } = row.case;
            println!(
                "| {grading:.3} | {exponent:.2} | {stick_ratio:.3} | {tau:.2} | {:e} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {} | {:.0e} |",
                row.accuracy,
                row.volume,
                row.depth,
                row.place[0],
                row.place[1],
                row.estimate,
                row.springs,
                row.uncertainty
            );
        }
    }
}
