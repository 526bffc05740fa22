//! The steps of a period along a line in which the indenter also moves up and down, and what the springs do in them.

mod pass;

pub use pass::PassedSteps;

use crate::laws::path::{Path, PathPoint};

/// Parts of a step in which springs are followed.
const PARTS: usize = 8;

/// Corners of a path per step below which the steps would be no fewer than its substeps.
const FEWEST_PARTS: usize = 3;

/// The steps of a period in which springs slip one way and those that are loaded all the way, by rules of third order between the kinks of what wears in it.
///
/// With `l = μ_f/M (q - lift)` the slip `u - e` of a spring lies between `u - l` and `u + l`: it is pushed on by `u + (μ_f/M) lift` while that grows and
/// pushed back by `u - (μ_f/M) lift` while that falls. Which of them pushes is the same for all springs, and they stick from where it turns. A step lies
/// between such turns, and extremes of the lift. Over it `f` from 0 to 1 is the part of the push that is through: `df` is in proportion to the slip of any spring
/// that slips. Slip and load are taken by their first two moments over `f`,
///
/// ```text
/// s_0 = ∫ ds,  s_1 = ∫ (2f - 1) ds,      q_0 = ∫ (q - lift)₊ df,  q_1 = 3 ∫ (2f - 1) (q - lift)₊ df,      ∫ (q - lift)₊ ds ≈ q_0 s_0 + q_1 s_1
/// ```
///
/// which is exact for a spring that slips all through the step, and is written as a sum over the two nodes of Gauss's rule, `q_0 ± q_1/√3` and
/// `s_0/2 ± √3 s_1/2`.
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    path: Path,
    /// The step of each substep of the path; none where nothing slips.
    step_of: Vec<Option<usize>>,
    /// `f` at the ends of each substep.
    through: Vec<[f64; 2]>,
    /// What pushes on, and what pushes back, in each substep, m.
    pushes: Vec<[f64; 2]>,
    steps: Vec<Step>,
    phases: Vec<Phase>,
    /// `μ_f/M`.
    slope: f64,
    /// Largest tangential displacement, m.
    reach: f64,
}

/// Substeps between two turns of what pushes, or of the lift.
#[derive(Debug, Clone, PartialEq)]
struct Phase {
    first: usize,
    end: usize,
}

/// One step.
#[derive(Debug, Clone, PartialEq)]
struct Step {
    /// Its substeps.
    first: usize,
    end: usize,
    /// Smallest and largest lift, m.
    lifts: [f64; 2],
    /// `∫ lift df` and `3 ∫ (2f - 1) lift df`, m.
    moments: [f64; 2],
    /// `∫ ds`, `∫ (2f - 1) ds` and `∫ lift ds` of a spring that slips on, or back, all through it, m, m and m².
    whole: [[f64; 3]; 2],
}

impl Steps {
    /// Columns in which slip and load are given, over the steps.
    pub const NODES: usize = 2;

    /// Corners of a path, over its steps, that are enough to follow springs by.
    pub const CORNERS: usize = PARTS;

    /// The steps of a path along a line; none if it turns so often that there would be hardly fewer than it has substeps.
    ///
    /// # Arguments
    /// * `path` -- one period, finely cut, with the corners at which springs begin to stick
    /// * `count` -- about how many steps
    /// * `slope` -- `μ_f/M`
    pub fn new(path: Path, count: usize, slope: f64) -> Option<Self> {
        let corners = path.points.len();
        let at = |m: usize| &path.points[m % corners];
        let moved = |m: usize| {
            let [from, to] = [at(m), at(m + 1)];
            [to.tangential[0] - from.tangential[0], to.lift - from.lift]
        };
        let pushes: Vec<[f64; 2]> = (0..corners)
            .map(|m| {
                let [along, up] = moved(m);
                [(along + slope * up).max(0.0), (slope * up - along).max(0.0)]
            })
            .collect();
        let kind = |m: usize| (pushes[m][0] > 0.0, pushes[m][1] > 0.0, moved(m)[1] > 0.0);
        let mut phases = vec![];
        let mut first = 0;
        for m in 1..=corners {
            if m == corners || kind(m) != kind(first) {
                let slips = pushes[first][0] > 0.0 || pushes[first][1] > 0.0;
                phases.push((first, m, slips));
                first = m;
            }
        }
        let slipping: usize = phases.iter().filter(|it| it.2).map(|(first, end, _)| end - first).sum();
        let mut found = Self {
            step_of: vec![None; corners],
            through: vec![[0.0; 2]; corners],
            steps: vec![],
            phases: phases.iter().map(|(first, end, _)| Phase { first: *first, end: *end }).collect(),
            slope,
            reach: path.points.iter().map(|it| it.tangential[0].abs()).fold(0.0, f64::max),
            pushes,
            path,
        };
        for (first, end, _) in phases.into_iter().filter(|it| it.2) {
            let substeps = end - first;
            let share = count as f64 * substeps as f64 / slipping as f64;
            let parts = (share.round() as usize).clamp(1, substeps);
            for part in 0..parts {
                found.add(first + part * substeps / parts, first + (part + 1) * substeps / parts);
            }
        }
        (found.steps.len() * FEWEST_PARTS <= corners).then_some(found)
    }

    fn add(&mut self, first: usize, end: usize) {
        let push = |m: usize| self.pushes[m].iter().sum::<f64>();
        let whole: f64 = (first..end).map(push).sum();
        let lifts = [f64::INFINITY, f64::NEG_INFINITY];
        let mut step = Step { first, end, lifts, moments: [0.0; 2], whole: [[0.0; 3]; 2] };
        let mut through = 0.0;
        for m in first..end {
            let next = if m + 1 == end { 1.0 } else { (through + push(m) / whole).min(1.0) };
            let lifts = [m, m + 1].map(|m| self.path.points[m % self.path.points.len()].lift);
            for lift in lifts {
                step.lifts = [step.lifts[0].min(lift), step.lifts[1].max(lift)];
            }
            let [mean, slope] = moments([through, next], lifts);
            step.moments = [step.moments[0] + mean, step.moments[1] + slope];
            self.through[m] = [through, next];
            self.step_of[m] = Some(self.steps.len());
            through = next;
            for side in 0..2 {
                let part = self.part(m, side, [0.0, 1.0]);
                step.whole[side].iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
            }
        }
        self.steps.push(step);
    }

    /// The path by which springs are followed.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Lifts the whole path further, m.
    pub fn lift(&mut self, by: f64) {
        self.path.points.iter_mut().for_each(|point| point.lift += by);
        for step in &mut self.steps {
            step.lifts = step.lifts.map(|lift| lift + by);
            step.moments[0] += by;
            step.whole.iter_mut().for_each(|[slip, _, lifted]| *lifted += by * *slip);
        }
    }

    /// Columns of slip and load.
    pub fn columns(&self) -> usize {
        Self::NODES * self.steps.len()
    }

    /// Which way springs slip at each node, 1 or -1; 0 where some go one way and some the other.
    pub fn ways(&self) -> Vec<f64> {
        let way = |step: &Step| match self.pushes[step.first] {
            [on, 0.0] if on > 0.0 => 1.0,
            [0.0, _] => -1.0,
            _ => 0.0,
        };
        self.steps.iter().flat_map(|step| [way(step); Self::NODES]).collect()
    }

    /// A corner of the path; after the last one comes the first.
    fn corner(&self, m: usize) -> &PathPoint {
        &self.path.points[if m < self.path.points.len() { m } else { m - self.path.points.len() }]
    }

    /// Load `(q - lift)₊` of a spring at the nodes and its derivative by `q`, m and 1, shape `(columns,)` each.
    ///
    /// # Arguments
    /// * `compression` -- at the largest indentation, m
    pub fn load(&self, compression: f64, mut node: impl FnMut(usize, f64, f64)) {
        let third = 3.0_f64.sqrt().recip();
        for (i, step) in self.steps.iter().enumerate() {
            let ([mean, aside], [by_mean, by_aside]) = if compression >= step.lifts[1] {
                ([compression - step.moments[0], -step.moments[1]], [1.0, 0.0])
            } else if compression <= step.lifts[0] {
                Default::default()
            } else {
                self.partly(step, compression)
            };
            node(2 * i, mean - third * aside, by_mean - third * by_aside);
            node(2 * i + 1, mean + third * aside, by_mean + third * by_aside);
        }
    }

    /// Moments of the load in a step within which a spring touches or lifts off, and their derivatives.
    fn partly(&self, step: &Step, compression: f64) -> ([f64; 2], [f64; 2]) {
        let (mut load, mut slope) = ([0.0; 2], [0.0; 2]);
        for m in step.first..step.end {
            let next = (m + 1) % self.path.points.len();
            let [mut from, mut to] = self.through[m];
            let [mut before, mut after] = [m, next].map(|m| compression - self.path.points[m].lift);
            match (before > 0.0, after > 0.0) {
                (false, false) => continue,
                (true, true) => {}
                (false, true) => {
                    from = to - (to - from) * after / (after - before);
                    before = 0.0;
                }
                (true, false) => {
                    to = from + (to - from) * before / (before - after);
                    after = 0.0;
                }
            }
            let of_load = moments([from, to], [before, after]);
            let of_touch = moments([from, to], [1.0; 2]);
            for i in 0..2 {
                load[i] += of_load[i];
                slope[i] += of_touch[i];
            }
        }
        (load, slope)
    }
}

/// `∫ v df` and `3 ∫ (2f - 1) v df` of a linear `v`.
fn moments([from, to]: [f64; 2], [before, after]: [f64; 2]) -> [f64; 2] {
    let length = to - from;
    let middle = (from + to - 1.0) * (before + after) * 2.0;
    let ends = (2.0 * from - 1.0) * before + (2.0 * to - 1.0) * after;
    [0.5 * length * (before + after), 0.5 * length * (ends + middle)]
}
