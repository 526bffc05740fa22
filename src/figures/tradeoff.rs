//! Error against cost, with the fronts and what `accuracy` chooses beside them.

use super::measure::Measure;
use crate::data::{Dataset, Words};
use crate::error::Result;
use crate::figures::drawing::{
    Axis, Colour, DISTINCT, Dash, Figure, Label, Panel, Row, Series, Shape, Spacing, Style, plain,
};
use crate::scene::{Cycle, Stepper};

/// A cost: dataset, name of its fronts, quantity and unit.
const COSTS: [(&str, &str, &str, &str); 2] =
    [("wall_seconds", "time", "wall time", "s"), ("rate_evaluations", "evaluations", "rate evaluations", "")];
/// An error: dataset, name of its fronts, and what it is of. The profile is compared at the radii of each run's own file.
const ERRORS: [(&str, &str, &str); 2] = [
    ("volume_error_max", "volume", "error of the worn volume"),
    ("node_error_max", "profile", "error of the profile"),
];
/// Errors below this are shown at it.
const FLOOR: f64 = 1e-16;
const CHOSEN: Colour = Colour([200, 0, 60]);

/// The candidates as far as figures need them.
struct Candidates<'a> {
    file: &'a Dataset,
    steppers: &'a Words,
    cycles: &'a Words,
    accuracies: &'a [f64],
}

pub(super) fn figure(file: &Dataset) -> Result<Figure> {
    let count = file.along("candidate")?.len();
    let candidates = Candidates {
        file,
        steppers: file.words("stepper", count)?,
        cycles: file.words("cycle", count)?,
        accuracies: file.numbers("accuracy", &[count])?,
    };
    let mut rows = vec![];
    for (place, error) in ERRORS.into_iter().enumerate() {
        let mut panels = COSTS.map(|cost| candidates.panel(cost, error, place));
        let [first, second] = &mut panels;
        if let (Ok(first), Ok(second)) = (first, second) {
            first.y.quantity = format!("{}, relative", error.2);
            let range = [first.y.range[0].min(second.y.range[0]), first.y.range[1].max(second.y.range[1])];
            (first.y.range, second.y.range) = (range, range);
            if place > 0 {
                first.series.iter_mut().for_each(|series| series.in_legend = false);
            }
            second.series.iter_mut().for_each(|series| series.in_legend = false);
        }
        rows.push(Row { height: 240.0, panels: panels.into_iter().collect::<Result<_>>()? });
    }
    let title = if file.title().is_empty() { None } else { Some(plain(file.title())) };
    let note = "Largest error over the snapshots, over worn volume and largest depth of the limit. Diamonds: numerics.accuracy as written.";
    Ok(Figure { title, rows, notes: vec![note.into()] })
}

impl Candidates<'_> {
    fn len(&self) -> usize {
        self.steppers.len()
    }

    fn panel(
        &self,
        cost: (&str, &str, &str, &str),
        error: (&str, &str, &str),
        place: usize,
    ) -> Result<Panel> {
        let (costs, errors) =
            (self.file.numbers(cost.0, &[self.len()])?, self.file.numbers(error.0, &[self.len()])?);
        let fronts = self.file.numbers(&format!("front_{}_{}", error.1, cost.1), &[self.len()])?;
        let point = |at: usize| [costs[at], errors[at].max(FLOOR)];
        let known: Vec<usize> =
            (0..self.len()).filter(|at| costs[*at] > 0.0 && errors[*at].is_finite()).collect();
        let unit = cost.3;
        let x = Measure::NUMBER.axis(cost.2, Spacing::Logarithmic, known.iter().map(|at| costs[*at]), 0.04);
        let surest = self.uncertainty(place);
        let heights = known.iter().map(|at| point(*at)[1]).chain(surest);
        let y = Measure::NUMBER.axis("", Spacing::Logarithmic, heights, 0.05);
        let mut panel = Panel::new(Axis { unit: unit.into(), ..x }, y);
        if let Some(surest) = surest {
            let ends = panel.x.range.map(|cost| [cost, surest]);
            let style = Style::Line { width: 1.1, dash: Dash::Dotted };
            panel.series.push(
                Series::new("uncertainty of the reference", style, Colour::GREY, ends.to_vec()).in_legend(),
            );
        }
        self.add_by_hand(&mut panel, &known, &point);
        let mut front: Vec<[f64; 2]> =
            known.iter().filter(|at| fronts[**at] == 1.0).map(|at| point(*at)).collect();
        front.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let style = Style::Line { width: 1.4, dash: Dash::Solid };
        panel.series.push(Series::new("front", style, Colour::BLACK, stairs(&front)).in_legend());
        self.add_chosen(&mut panel, &known, &point);
        Ok(panel)
    }

    /// Candidates with springs and tolerances by hand: a colour and shape for each stepper, crosses where the cycle is resolved.
    fn add_by_hand(&self, panel: &mut Panel, known: &[usize], point: &dyn Fn(usize) -> [f64; 2]) {
        for (number, stepper) in Stepper::ALL.into_iter().enumerate() {
            for cycle in [Cycle::ClosedForm, Cycle::Resolved] {
                let is_one = |at: &usize| {
                    self.accuracies[*at].is_nan()
                        && self.steppers.get(*at) == stepper.name()
                        && self.cycles.get(*at) == cycle.name()
                };
                let points: Vec<[f64; 2]> = known.iter().copied().filter(is_one).map(point).collect();
                if points.is_empty() {
                    continue;
                }
                let (shape, name) = match cycle {
                    Cycle::ClosedForm => (Shape::ALL[number], stepper.name().to_owned()),
                    Cycle::Resolved => (Shape::Cross, format!("{}, resolved cycle", stepper.name())),
                };
                let style = Style::Points { shape, radius: 2.4 };
                panel.series.push(Series::new(name, style, DISTINCT[number], points).in_legend());
            }
        }
    }

    fn add_chosen(&self, panel: &mut Panel, known: &[usize], point: &dyn Fn(usize) -> [f64; 2]) {
        let asked: Vec<usize> = known.iter().copied().filter(|at| self.accuracies[*at].is_finite()).collect();
        let style = Style::Points { shape: Shape::Diamond, radius: 3.6 };
        let points = asked.iter().map(|at| point(*at)).collect();
        panel.series.push(Series::new("accuracy", style, CHOSEN, points).in_legend());
        for at in asked {
            let exponent = self.accuracies[at].log10().round();
            let text = format!("10^{{−{}}}", exponent.abs());
            panel.labels.push(Label { shift: [6.0, -4.0], ..Label::new(text, point(at), CHOSEN) });
        }
    }

    /// Uncertainty of the reference in volume and profile.
    fn uncertainty(&self, place: usize) -> Option<f64> {
        let text = self.file.text("reference_uncertainty")?;
        text.split(',')
            .nth(place)?
            .trim()
            .parse()
            .ok()
            .filter(|value: &f64| *value > 0.0 && value.is_finite())
    }
}

/// A front as steps: an error is had for its cost and all that is more.
fn stairs(front: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut line: Vec<[f64; 2]> = vec![];
    for point in front {
        if let Some(last) = line.last() {
            line.push([point[0], last[1]]);
        }
        line.push(*point);
    }
    line
}
