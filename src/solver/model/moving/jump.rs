//! A jump of the edge of stick between two blocks.

use super::StickEdge;
use crate::contact::slip_depth::UnwornValues;
use crate::error::Result;
use crate::numerics::roots::{bracketed, next_to};
use crate::solver::model::schedule::{AmplitudeControl, CycleLoading};
use crate::solver::model::{Fields, Model, Past, State, StickZone};

/// Steps of the integrals over the ground that comes to rest, or that leaves it, in a jump of the edge of stick.
const JUMP_STEPS: usize = 1000;

/// Of how many of these places one is kept for the cubics of an edge that may turn.
const SMOOTHED: usize = 25;

/// Parts of a squared radius around which the balance of forces on the springs is looked for: the least, by how much the next is larger, and the largest.
const NEXT_TO: f64 = 1e-6;
const WIDER: f64 = 8.0;
const FARTHEST: f64 = 0.1;

/// Squared radii and compressions that differ by less than this part are the same by two ways.
const SAME_PLACE: f64 = 1e-12;

/// The equivalent profile when a block ends, from the springs and, within the edge of stick, from what was left there.
struct Ground<'a> {
    model: &'a Model,
    /// Squared radius of the edge of stick, m².
    stick_area: f64,
    /// `Z`, m².
    slip_area: f64,
    /// `d`, m.
    indentation: f64,
    /// Compressions at the springs, the contact edge included, m.
    compression: Vec<f64>,
    /// That at the edge of stick, m.
    before: f64,
    stick: &'a StickEdge,
}

impl Ground<'_> {
    /// By how much wear has raised the equivalent profile at a squared radius, m.
    fn raised(&self, squared: f64) -> f64 {
        match self.on_springs(squared) {
            Some(compression) => self.indentation - compression - self.unworn(squared),
            None => self.raised_within(squared),
        }
    }

    /// Compression at a squared radius, m.
    fn compression(&self, squared: f64) -> f64 {
        let within = || self.indentation - self.unworn(squared) - self.raised_within(squared);
        self.on_springs(squared).unwrap_or_else(within)
    }

    /// Height of the unworn equivalent profile, m.
    fn unworn(&self, squared: f64) -> f64 {
        self.model.contact.equivalent_profile().value(squared.sqrt())
    }

    /// As [`Ground::raised`], within the edge of stick.
    fn raised_within(&self, squared: f64) -> f64 {
        if self.model.moving().is_some_and(|moving| moving.jumps) {
            self.stick.raised_at_rest(squared)
        } else {
            self.stick.ground_at_rest(squared)[0]
        }
    }

    /// Compression between the springs, m; none within the edge of stick.
    fn on_springs(&self, squared: f64) -> Option<f64> {
        if squared < self.stick_area {
            return None;
        }
        let nodes = &self.model.annulus().operators.abel.nodes()[1..];
        Some(match (squared - self.stick_area) / self.slip_area {
            // Next to the old edge, where springs may have lost their load within the first cell, the first spring's.
            x if x < nodes[0] => {
                self.compression[0] + (self.before - self.compression[0]) * (1.0 - x / nodes[0])
            }
            x => self.model.between_springs(&self.compression, x),
        })
    }
}

impl StickEdge {
    /// By how much wear has raised the equivalent profile within the edge of stick, m: linear between the places known.
    fn raised_at_rest(&self, squared: f64) -> f64 {
        let after = self.places_at_rest.partition_point(|place| *place <= squared);
        match after {
            0 => 0.0,
            after if after == self.places_at_rest.len() => self.raised_at_rest[after - 1],
            after => {
                let [low, high] =
                    [after - 1, after].map(|i| (self.places_at_rest[i], self.raised_at_rest[i]));
                low.1 + (high.1 - low.1) * (squared - low.0) / (high.0 - low.0)
            }
        }
    }
}

impl Model {
    /// The state in which a new block begins, if one does since `before`, cycles: where the edge of stick jumps, the mesh begins anew there. In a pause it
    /// stays where it was.
    ///
    /// Outwards the ground that comes to rest is kept. Inwards it is given back to the springs; within all that ever came to rest it is unworn.
    ///
    /// # Errors
    /// [`Error::NotConverged`](crate::Error::NotConverged) if no spring has the compression at which stick would end.
    pub fn begin_block(&self, mut state: State, before: f64) -> Result<State> {
        if !self.schedule.begins_block(before, state.cycles) {
            return Ok(state);
        }
        if self.gross().is_some() {
            return self.in_block_of(state);
        }
        state = self.with_resting_area(state);
        let (Some(moving), Some(stick)) = (self.moving(), &state.stick) else { return Ok(state) };
        if !moving.jumps && !moving.in_blocks {
            return Ok(state);
        }
        if self.schedule.rests_or_goes_on(state.cycles) {
            return Ok(state);
        }
        let loading = self.schedule.loading(state.cycles, state.cycles);
        let loading = self.after_energy(loading, state.dissipated_energy);
        let indentation = self.indentation(&state);
        let before = indentation - stick.depth;
        let ratio = self.contact.half_space().stiffness_ratio();
        let driven =
            (loading.control == AmplitudeControl::Displacement).then(|| loading.slip_compression(ratio));
        if driven.is_some_and(|compression| (compression / before - 1.0).abs() < SAME_PLACE) {
            return Ok(state);
        }
        let mut on_springs = state.compression.clone();
        on_springs.push(0.0);
        let (old, slip_area) = (stick.area, state.slip_area);
        let ground = Ground {
            model: self,
            stick_area: old,
            slip_area,
            indentation,
            compression: on_springs,
            before,
            stick,
        };
        let bounds @ [least, most] = [self.stick_zone.stick_area, old + slip_area];
        let Some(compression) = driven else {
            let area = self.edge_in_balance(&ground, &loading, bounds, &state)?;
            return Ok(self.begun_in_balance(&ground, &loading, area, bounds, &state));
        };
        let excess = |squared: f64| ground.compression(squared) - compression;
        let new = match compression {
            _ if compression < before => bracketed(excess, old, most, 0.0)?,
            _ if excess(least) <= 0.0 => least,
            _ => bracketed(excess, least, old, 0.0)?,
        };
        Ok(self.begun_at(&ground, new, compression, &state))
    }

    /// The state with the edge of stick where tangential forces balance on the springs of the mesh that begins there: next to worn ground that is steeper than springs are apart, the profile between
    /// those before tells it roughly.
    ///
    /// # Arguments
    /// * `guess` -- squared radius, m²
    /// * `least`, `most` -- its bounds
    fn begun_in_balance(
        &self,
        ground: &Ground,
        loading: &CycleLoading,
        guess: f64,
        [least, most]: [f64; 2],
        state: &State,
    ) -> State {
        let begun = |area: f64| self.begun_at(ground, area, ground.compression(area), state);
        let excess = |area: f64| {
            let next = begun(area);
            let displaced = self.displaced(loading.clone(), ground.compression(area));
            let amplitude = displaced.amplitude;
            loading
                .excess(self.force(&displaced, &next.compression, &self.fields(&next), amplitude), amplitude)
        };
        // Springs that come to steep ground bend it.
        let mut part = NEXT_TO;
        let around = loop {
            let ends = [(1.0 - part) * guess, (1.0 + part) * guess].map(|area| area.clamp(least, most));
            let [below, above] = ends.map(excess);
            if below * above <= 0.0 {
                break Some(ends);
            }
            if part > FARTHEST {
                break None;
            }
            part *= WIDER;
        };
        let found = around.and_then(|[low, high]| bracketed(excess, low, high, 0.0).ok());
        begun(found.unwrap_or(guess))
    }

    /// The state with the edge of stick at a squared radius, m², where the compression is that of slip, m.
    fn begun_at(&self, ground: &Ground, new: f64, compression: f64, state: &State) -> State {
        let (stick, indentation) = (ground.stick, ground.indentation);
        let (old, slip_area) = (ground.stick_area, ground.slip_area);
        let moving = self.moving().expect("the edge of stick moves");
        let profile = self.contact.equivalent_profile();
        let exponent = 1.0 + profile.grading();
        let (mut left_behind, mut load) = (stick.left_behind.clone(), stick.load);
        let (mut places_at_rest, mut raised_at_rest) =
            (stick.places_at_rest.clone(), stick.raised_at_rest.clone());
        // Outwards denser next to the old edge, as the springs are; inwards at the places known.
        let mut places: Vec<f64> = if new > old {
            (0..=JUMP_STEPS).map(|i| old + (new - old) * (i as f64 / JUMP_STEPS as f64).powi(4)).collect()
        } else {
            let known = places_at_rest.iter().copied().filter(|place| *place > new && *place < old);
            let first = places_at_rest.first().map_or(old, |first| first.min(old));
            let unworn = (0..JUMP_STEPS).map(|i| new + (first - new) * i as f64 / JUMP_STEPS as f64);
            let unworn = unworn.filter(|place| *place < first);
            let within = std::iter::once(new).filter(|_| new >= first);
            unworn.chain(within).chain(known).chain([old]).collect()
        };
        places.dedup();
        let sign = if new > old { 1.0 } else { -1.0 };
        let raised: Vec<f64> = places.iter().map(|place| ground.raised(*place)).collect();
        // None where no ground is left behind.
        let stations: Vec<f64> = moving.stations().take(left_behind.len()).collect();
        self.add_of_steps([&places, &raised], -sign, &stations, &mut left_behind);
        for ends in places.windows(2) {
            let middle = 0.5 * (ends[0] + ends[1]);
            let borne = ground.compression(middle) * middle.powf(0.5 * (exponent - 2.0));
            load += sign * 0.5 * (ends[1] - ends[0]) * borne;
        }
        if new > old {
            let known = usize::from(!places_at_rest.is_empty());
            // Cubics through all of them would show the swings between springs.
            let every = if moving.jumps { 1 } else { SMOOTHED };
            let kept = |values: &[f64]| values.iter().copied().step_by(every).skip(known).collect::<Vec<_>>();
            places_at_rest.extend(kept(&places));
            raised_at_rest.extend(kept(&raised));
        } else {
            let kept = places_at_rest.partition_point(|place| *place < new * (1.0 - SAME_PLACE));
            places_at_rest.truncate(kept);
            raised_at_rest.truncate(kept);
            if kept > 0 {
                places_at_rest.push(new);
                raised_at_rest.push(stick.raised_at_rest(new));
            } else {
                // The ground within is unworn.
                left_behind.fill(0.0);
            }
        }
        let next = StickZone { stick_area: new, slip_compression: compression, stick_load: load };
        let (mut fields, moved_area) = (self.fields(state), slip_area - (new - old));
        // Slip is what is carried over: small numbers next to the edge of stick, where compressions differ by little.
        // Ground at rest of which few places are kept tells depths worse than the springs do.
        let tells_depth = stick.places_at_rest.is_empty() || moving.jumps && places_at_rest.is_empty();
        let (slip_area, moved) = if new < old && tells_depth {
            self.on_unworn_ground(&next, &fields, stick, moved_area)
        } else {
            self.evaluate_at(&next, moved_area, &state.compression, &mut fields);
            let nodes = &self.annulus().operators.abel.nodes()[1..];
            let (radius, at_edge) = (new.sqrt(), ground.raised(new));
            let slipping = nodes.iter().map(|x| {
                let rise =
                    profile.rise(radius, moved_area * x) + ground.raised(new + moved_area * x) - at_edge;
                rise.max(0.0)
            });
            let slip = self.carried(&fields, slipping);
            // What is left behind is by another quadrature than the slip: the contact edge stays where it is.
            let behind = moving.left_behind(&left_behind, new + moved_area);
            let off = self.mismatch_at(&next, moved_area, |i, _| slip[i]) - behind;
            left_behind.iter_mut().for_each(|value| *value += off);
            (moved_area, self.compression_at(&next, moved_area, |i, _| slip[i]))
        };
        let next = State {
            slip_area,
            compression_rate: vec![0.0; moved.len()],
            compression: moved,
            slip_area_rate: 0.0,
            past: Past::default(),
            stick: Some(StickEdge {
                area: new,
                depth: indentation - compression,
                load,
                left_behind,
                wear_depth: stick.wear_depth.clone(),
                places_at_rest,
                raised_at_rest,
                slip_compression: moving.kept(compression),
                rates: [0.0; 3],
            }),
            ..state.clone()
        };
        if moving.in_blocks { self.close_force(next) } else { next }
    }

    /// Slip area, m², and compressions, m, of a mesh that begins anew within unworn ground: the depth worn at each place stays,
    ///
    /// ```text
    /// S = S_0 + w,    w = S' - S_0' + Σ Δh Φ
    /// ```
    ///
    /// with slip as it was on the mesh before, and steps `Δh` of the equivalent profile on the ground that came to rest within that.
    ///
    /// # Arguments
    /// * `fields`, `stick` -- of the mesh before
    /// * `guess` -- slip area of the contact edge before
    fn on_unworn_ground(
        &self,
        next: &StickZone,
        fields: &Fields,
        stick: &StickEdge,
        guess: f64,
    ) -> (f64, Vec<f64>) {
        let before = &fields.stick_zone;
        let nodes = &self.annulus().operators.abel.nodes()[1..];
        let on_springs = |squared: f64| {
            let from = squared - before.stick_area;
            let x = from / fields.slip_area;
            if x <= 0.0 || x >= 1.0 {
                return 0.0;
            }
            let unworn = self.unworn_at(before, from).slip;
            // Within the first cell slip may have grown by any factor, which no polynomial extrapolates.
            unworn * self.between_springs(&fields.log_slip, x.max(nodes[0])).exp_m1()
        };
        let at_slip_area = |slip_area: f64| {
            let places: Vec<f64> = nodes.iter().map(|x| next.stick_area + slip_area * x).collect();
            let mut worn: Vec<f64> = places.iter().map(|squared| on_springs(*squared)).collect();
            self.add_of_steps([&stick.places_at_rest, &stick.raised_at_rest], 1.0, &places, &mut worn);
            worn
        };
        let with = |worn: Vec<f64>| move |i: usize, unworn: &UnwornValues| unworn.slip + worn[i];
        let slip_area =
            next_to(|slip_area| self.mismatch_at(next, slip_area, with(at_slip_area(slip_area))), guess);
        (slip_area, self.compression_at(next, slip_area, with(at_slip_area(slip_area))))
    }

    /// Adds the slip depth `Σ Δh Φ`, m, of steps of the equivalent profile within squared radii, m², that increase.
    ///
    /// # Arguments
    /// * `places`, `heights` -- squared radii, m², and heights there, m
    /// * `factor` -- on all steps
    fn add_of_steps(&self, [places, heights]: [&[f64]; 2], factor: f64, squared: &[f64], to: &mut [f64]) {
        let mut uniform = vec![0.0; squared.len()];
        for (ends, heights) in places.windows(2).zip(heights.windows(2)) {
            let step = factor * (heights[1] - heights[0]);
            if step == 0.0 {
                continue;
            }
            let middle = 0.5 * (ends[0] + ends[1]);
            let within = squared.partition_point(|it| *it <= middle);
            let (beyond, uniform) = (&squared[within..], &mut uniform[within..]);
            self.annulus().unworn.fill_uniform_at_stick(middle, |i| beyond[i] - middle, uniform);
            to[within..].iter_mut().zip(uniform).for_each(|(value, uniform)| *value += step * *uniform);
        }
    }

    /// Squared radius, m², at which stick ends where a balance of tangential forces begins anew on the profile as it is.
    ///
    /// ```text
    /// F_x = 2 c_N [τ(q_c) c^(1+k)/(1+k) + ∫_c^a x^k τ(q) dx],    dF_x = 2 c_N c^(1+k)/(1+k) dτ(q_c),    U = τ(q_c)/M
    /// ```
    ///
    /// The springs between the edge before and the new one bear by the profile rather than by the quadrature over the mesh.
    ///
    /// # Errors
    /// [`Error::NotConverged`](crate::Error::NotConverged) if there is no such place within the contact.
    fn edge_in_balance(
        &self,
        ground: &Ground,
        loading: &CycleLoading,
        [least, most]: [f64; 2],
        state: &State,
    ) -> Result<f64> {
        let half_space = self.contact.half_space();
        let exponent = 1.0 + half_space.grading();
        let old = ground.stick_area;
        let strength = |compression: f64| loading.friction.static_strength(compression);
        let displacement = |strength: f64| strength / half_space.stiffness_ratio();
        let before = self.displaced(loading.clone(), ground.before);
        let held = self.force(&before, &state.compression, &self.fields(state), before.amplitude);
        let excess = |squared: f64| {
            let cells = |i: usize| old + (squared - old) * (i as f64 / JUMP_STEPS as f64).powi(4);
            let (mut place, mut at_place) = (old, strength(ground.before));
            let mut gained = 0.0;
            for i in 1..=JUMP_STEPS {
                let (next, at_next) = (cells(i), strength(ground.compression(cells(i))));
                gained += (at_next - at_place) * (0.5 * (place + next)).powf(0.5 * exponent) / exponent;
                (place, at_place) = (next, at_next);
            }
            loading.excess(held + 2.0 * half_space.normal_stiffness() * gained, displacement(at_place))
        };
        if excess(least) <= 0.0 {
            return Ok(least);
        }
        bracketed(excess, least, most, 0.0)
    }
}
