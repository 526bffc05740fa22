//! What a run shows, and how far that is from a reference.

use std::fmt::Write as _;
use std::ops::Range;

use fretwear::Results;
use fretwear::solver::simulation::{self as stepping, Observer};

/// Radii at which a reference is seen.
const DENSE: usize = 3000;

/// What is seen at a snapshot.
#[derive(Default, Clone)]
pub struct Seen {
    pub tau: f64,
    pub volume: f64,
    pub depth: Vec<f64>,
}

/// A run by what it shows.
#[derive(Default, Clone)]
pub struct Shown {
    pub springs: usize,
    /// Over the contact radius at the start.
    pub radius: Vec<f64>,
    pub seen: Vec<Seen>,
    /// Volume and depth of the limit.
    pub limit: Option<[f64; 2]>,
    /// Contact radius at each snapshot over that at the start, where the radii are the run's own: wear ends there with a kink.
    pub edges: Vec<f64>,
}

impl Shown {
    pub fn of(results: &Results) -> Self {
        let contact_radius = results.contact_radius()[0];
        let deepest = |depth: &[f64]| depth.iter().copied().fold(0.0, f64::max);
        let limit = results.limit().zip(results.limit_curves());
        Self {
            springs: results.springs(),
            radius: results.radius().iter().map(|r| r / contact_radius).collect(),
            seen: results
                .snapshots()
                .iter()
                .skip(1)
                .map(|it| Seen { tau: it.tau, volume: it.wear_volume, depth: it.wear_depth.clone() })
                .collect(),
            limit: limit.map(|(limit, curves)| [limit.wear_volume(), deepest(&curves.wear_depth)]),
            edges: vec![],
        }
    }

    /// Lines: springs and limit; radii; edges; then of each snapshot time, volume and depths.
    pub fn written(&self) -> String {
        let [volume, depth] = self.limit.unwrap_or_default();
        let mut text = format!("{} {volume:e} {depth:e}\n", self.springs);
        let mut line = |first: &[f64], values: &[f64]| {
            let all: Vec<String> = first.iter().chain(values).map(|value| format!("{value:e}")).collect();
            writeln!(text, "{}", all.join(" ")).expect("text");
        };
        line(&[], &self.radius);
        line(&[], &self.edges);
        self.seen.iter().for_each(|it| line(&[it.tau, it.volume], &it.depth));
        text
    }

    pub fn read(text: &str) -> Option<Self> {
        let mut lines = text
            .lines()
            .map(|line| line.split(' ').filter_map(|it| it.parse::<f64>().ok()).collect::<Vec<_>>());
        let head = lines.next()?;
        let [springs, volume, depth] = *head else { return None };
        let radius = lines.next()?;
        let edges = lines.next()?;
        let seen = lines.map(|it| Seen { tau: it[0], volume: it[1], depth: it[2..].to_vec() }).collect();
        let limit = (volume > 0.0).then_some([volume, depth]);
        Some(Self { springs: springs as usize, radius, seen, limit, edges })
    }

    /// Least and largest depth at a radius by straight line, parabolas and cubic through its neighbours, over the fourth root of the distance from the
    /// innermost: beyond a kink one of them is right. None outside.
    fn depth_at(&self, depth: &[f64], radius: f64, edge: Option<f64>) -> Option<[f64; 2]> {
        let (first, last) = (self.radius[0], self.radius[self.radius.len() - 1]);
        if radius < first || radius > last {
            return None;
        }
        let over = |r: f64| (r - first * (1.0 - 1e-9)).max(0.0).powf(0.25);
        let above = self.radius.partition_point(|r| *r < radius).clamp(2, self.radius.len() - 2);
        let x = over(radius);
        let through = |near: Range<usize>| {
            let value = |i: usize| {
                let others = near.clone().filter(|j| *j != i).map(|j| over(self.radius[j]));
                let at = over(self.radius[i]);
                depth[i] * others.map(|other| (x - other) / (at - other)).product::<f64>()
            };
            near.clone().map(value).sum::<f64>()
        };
        let mut found =
            [above - 2..above + 1, above - 1..above + 2, above - 2..above + 2, above - 1..above + 1]
                .map(through)
                .to_vec();
        if let Some(edge) = edge.filter(|edge| (self.radius[above - 1]..self.radius[above]).contains(edge)) {
            // Within the cell of the contact edge: nothing beyond, and on this side a line and a parabola through a depth of zero there.
            let [outer, inner] = [above - 1, above - 2].map(|i| (self.radius[i], depth[i]));
            let line = |(r, w): (f64, f64)| w * (edge - radius) / (edge - r);
            let parabola =
                (line(outer) * (radius - inner.0) - line(inner) * (radius - outer.0)) / (outer.0 - inner.0);
            found = if radius >= edge { vec![0.0] } else { vec![line(outer), parabola] };
        }
        Some([
            found.iter().copied().fold(f64::INFINITY, f64::min),
            found.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ])
    }

    /// Distance of a point from the curve, by depth over the largest or by radius over the contact radius, whichever is larger.
    fn distance(&self, depth: &[f64], [radius, worn]: [f64; 2], scale: f64, most: f64) -> f64 {
        let points = self.radius.iter().zip(depth).map(|(r, w)| [(r - radius), (w - worn) / scale]);
        let points: Vec<[f64; 2]> = points.filter(|[r, _]| r.abs() <= 2.0 * most + 0.02).collect();
        let size = |[x, y]: [f64; 2]| x.abs().max(y.abs());
        // The segments are short beside what is asked for, or straight: a hundred places on each serve.
        let between = points.windows(2).flat_map(|pair| {
            (0..=100).map(move |i| {
                let part = 0.01 * f64::from(i);
                size([0, 1].map(|axis| pair[0][axis] + part * (pair[1][axis] - pair[0][axis])))
            })
        });
        between.fold(most, f64::min)
    }
}

/// A run at [`DENSE`] radii, or at its own where an edge of stick has left worn ground behind.
#[derive(Default)]
pub struct Dense {
    pub first_radius: f64,
    pub radius: Vec<f64>,
    pub seen: Vec<Seen>,
    pub edges: Vec<f64>,
}

impl Observer for Dense {
    fn output(&mut self, simulation: &stepping::Simulation) -> fretwear::Result<()> {
        let (model, state, fields) = (simulation.model(), simulation.state(), simulation.fields());
        let behind = state.stick.as_ref().is_some_and(|stick| !stick.wear_depth.is_empty());
        let (radii, offsets) = (model.radii(), model.offsets());
        let (first, last) = (offsets[0].powf(0.25), offsets[offsets.len() - 1].powf(0.25));
        let stick_area = radii[0].powi(2) - offsets[0];
        let dense = (0..DENSE).map(|i| (first + (last - first) * i as f64 / (DENSE - 1) as f64).powi(4));
        let offsets = if behind { offsets } else { dense.collect() };
        if state.cycles == 0.0 {
            self.first_radius = model.contact_radius(state);
            return Ok(());
        }
        self.radius = offsets.iter().map(|offset| (stick_area + offset).sqrt() / self.first_radius).collect();
        if behind {
            self.edges.push(model.contact_radius(state) / self.first_radius);
        }
        let depth = |offset: &f64| model.wear_depth_at(state, fields, *offset).max(0.0);
        self.seen.push(Seen {
            tau: state.cycles * model.contact().tau_per_cycle(),
            volume: model.worn_volume(state, fields),
            depth: if behind {
                model.radial_wear_depth(state, fields, 1)
            } else {
                offsets.iter().map(depth).collect()
            },
        });
        Ok(())
    }
}

/// Errors of a run: of volume, of the profile, and where the latter is, by radius over the contact radius and by time.
pub fn errors(run: &Shown, reference: &Shown, moves: bool) -> ([f64; 2], [f64; 2]) {
    let own = |value: fn(&Seen) -> f64| reference.seen.iter().map(value).fold(0.0, f64::max);
    let deepest = |it: &Seen| it.depth.iter().copied().fold(0.0, f64::max);
    let [volume_scale, scale] = reference.limit.unwrap_or_else(|| [own(|it| it.volume), own(deepest)]);
    let (mut volume, mut profile, mut place) = (0.0_f64, 0.0_f64, [0.0; 2]);
    for it in &run.seen {
        let same = |that: &Seen| (that.tau / it.tau - 1.0).abs() < 1e-9;
        let Some(index) = reference.seen.iter().position(same) else { continue };
        let (exact, edge) = (&reference.seen[index], reference.edges.get(index).copied());
        volume = volume.max((it.volume - exact.volume).abs() / volume_scale);
        for (radius, worn) in run.radius.iter().zip(&it.depth) {
            let Some([least, most]) = reference.depth_at(&exact.depth, *radius, edge) else { continue };
            let mut off = (least - worn).max(worn - most).max(0.0) / scale;
            if moves && off > profile {
                off = reference.distance(&exact.depth, [*radius, *worn], scale, off);
            }
            if off > profile {
                (profile, place) = (off, [*radius, it.tau]);
            }
        }
    }
    ([volume, profile], place)
}
