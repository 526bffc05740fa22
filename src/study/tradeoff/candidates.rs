//! What is tried on a scene: every stepper, every way through a cycle, ladders of springs and tolerances, and what `accuracy` chooses.

use std::fmt::Write;

use crate::error::{Error, Result};
use crate::scene::{Cycle, FINEST_ACCURACY, Scene, Stepper};

/// The ladders, of which every rung is combined with every other.
#[derive(Debug, Clone, PartialEq)]
pub struct Ladders {
    /// Springs over the slip annulus, increasing.
    pub springs: Vec<usize>,
    /// Tolerances of the time stepping, falling.
    pub tolerances: Vec<f64>,
    /// Values of `accuracy`, falling.
    pub accuracies: Vec<f64>,
    /// Methods of time stepping.
    pub steppers: Vec<Stepper>,
}

impl Default for Ladders {
    /// 15 to 480 springs doubled, tolerances from 1e-2 to 1e-8 and accuracies from 1e-2 to 1e-6 by tens, all steppers.
    fn default() -> Self {
        let tens =
            |last: i32| (2..=last).map(|power| format!("1e-{power}").parse().expect("a number")).collect();
        Self {
            springs: vec![15, 30, 60, 120, 240, 480],
            tolerances: tens(8),
            accuracies: tens(6),
            steppers: Stepper::ALL.to_vec(),
        }
    }
}

impl Ladders {
    /// Most rungs of one ladder.
    pub const MOST: usize = 50;

    /// Sorts every ladder from coarse to fine, and checks that a scene may ask for each rung.
    ///
    /// # Errors
    /// [`Error::Option`] names the ladder and the value.
    pub fn sorted(mut self) -> Result<Self> {
        let wrong = |name, why: String| Err(Error::Option { name, why });
        for (what, count) in [
            ("springs", self.springs.len()),
            ("tolerances", self.tolerances.len()),
            ("accuracies", self.accuracies.len()),
        ] {
            if count > Self::MOST {
                return wrong(what, format!("{count} values, more than {}", Self::MOST));
            }
        }
        if let Some(few) = self.springs.iter().find(|count| **count < 3) {
            return wrong("springs", format!("{few} is outside [3, inf)"));
        }
        if let Some(value) = self.tolerances.iter().find(|it| !(**it > 0.0 && **it <= 0.1)) {
            return wrong("tolerances", format!("{value} is outside (0, 0.1]"));
        }
        if let Some(value) = self.accuracies.iter().find(|it| !(FINEST_ACCURACY..=0.1).contains(*it)) {
            return wrong("accuracies", format!("{value} is outside [1e-10, 0.1]"));
        }
        if self.springs.is_empty() || self.tolerances.is_empty() || self.steppers.is_empty() {
            return wrong(
                "ladder",
                "give at least one number of springs, one tolerance and one stepper".into(),
            );
        }
        self.springs.sort_unstable();
        self.springs.dedup();
        for falling in [&mut self.tolerances, &mut self.accuracies] {
            falling.sort_by(|a, b| b.total_cmp(a));
            falling.dedup();
        }
        // In the order in which they are known, each once.
        self.steppers = Stepper::ALL.into_iter().filter(|it| self.steppers.contains(it)).collect();
        Ok(self)
    }
}

/// How a candidate was chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Choice {
    /// By hand.
    Hand {
        /// Springs over the slip annulus.
        springs: usize,
        /// Tolerance of the time stepping.
        tolerance: f64,
    },
    /// By the accuracy asked for.
    Accuracy(f64),
}

/// One way to compute the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Springs and tolerance, or what decides them.
    pub choice: Choice,
    /// Method of time stepping; with `accuracy` the default.
    pub stepper: Stepper,
    /// How a cycle is passed through.
    pub cycle: Cycle,
}

impl Candidate {
    /// The table `[numerics]` that asks for it; what else the scene says there about periods is kept.
    pub(super) fn numerics(&self, scene: &Scene) -> String {
        let mut text = match self.choice {
            Choice::Accuracy(accuracy) => format!("accuracy = {accuracy:e}\n"),
            Choice::Hand { springs, tolerance } => format!(
                "springs = {springs}\ntolerance = {tolerance:e}\nstepper = {:?}\ncycle = {:?}\n",
                self.stepper.name(),
                self.cycle.name()
            ),
        };
        if let Some(substeps) = scene.numerics().substeps {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "substeps = {substeps}");
        }
        text
    }

    /// The accuracy asked for.
    pub fn accuracy(&self) -> Option<f64> {
        match self.choice {
            Choice::Accuracy(accuracy) => Some(accuracy),
            Choice::Hand { .. } => None,
        }
    }

    /// Whether the two differ in springs and tolerance only.
    pub(super) fn is_akin(&self, other: &Self) -> bool {
        (self.stepper, self.cycle) == (other.stepper, other.cycle)
            && self.accuracy().is_some() == other.accuracy().is_some()
    }
}

/// How cycles of the scene can be passed through, the default first.
pub(super) fn cycles(scene: &Scene) -> &'static [Cycle] {
    if scene.conditions().mode.is_tangential() { &Cycle::ALL } else { &[Cycle::Resolved] }
}

/// All candidates; of those that differ in springs and tolerance only the coarser come first.
pub(super) fn candidates(scene: &Scene, ladders: &Ladders) -> Vec<Candidate> {
    let mut found = vec![];
    // The methods of large steps first: what they cost is known soonest.
    for &stepper in ladders.steppers.iter().rev() {
        // Steps of one cycle have no tolerance to keep.
        let count = if stepper == Stepper::EveryCycle { 1 } else { ladders.tolerances.len() };
        for &cycle in cycles(scene) {
            for &springs in &ladders.springs {
                let of = |&tolerance: &f64| Candidate {
                    choice: Choice::Hand { springs, tolerance },
                    stepper,
                    cycle,
                };
                found.extend(ladders.tolerances[..count].iter().map(of));
            }
        }
    }
    let chosen = |&accuracy: &f64| Candidate {
        choice: Choice::Accuracy(accuracy),
        stepper: Stepper::default(),
        cycle: cycles(scene)[0],
    };
    found.extend(ladders.accuracies.iter().map(chosen));
    found
}
