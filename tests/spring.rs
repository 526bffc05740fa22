//! One spring through the period of a path, against closed forms, its own energy and brute force.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use fretwear::contact::spring::{
    Shakedown, SpringCycle, searched_stick_compression, settled_cycle, steady_cycle, stick_compression,
};
use fretwear::contact::stick_slip::slip_amplitude_of_spring;
use fretwear::laws::friction::{Coulomb, FrictionLaw, LoadDependent, StaticKinetic};
use fretwear::laws::motion::{Mode, NormalOscillation, Orbit, RecordedPath, SampledPath, Tangential};
use fretwear::laws::path::{Path, PathPoint};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const M: f64 = 0.8;

fn coulomb(coefficient: f64) -> Coulomb {
    Coulomb { coefficient }
}

fn laws() -> [&'static dyn FrictionLaw; 4] {
    [
        &Coulomb { coefficient: 0.45 },
        &StaticKinetic { static_coefficient: 0.6, kinetic_coefficient: 0.35 },
        &LoadDependent { coefficient: 0.45, exponent: -0.4, reference: 1.7 },
        &LoadDependent { coefficient: 0.45, exponent: 0.5, reference: 1.7 },
    ]
}

fn cycle(path: &Path, law: &dyn FrictionLaw, compression: f64) -> SpringCycle {
    let mut out = SpringCycle::default();
    steady_cycle(path, law, M, compression, &Shakedown::default(), &mut out);
    out
}

fn sampled(mode: &dyn Mode, amplitude: f64, substeps: usize) -> Path {
    SampledPath::new(mode, amplitude, 10.0, substeps).path
}

fn normal(amplitude: f64, frequency_ratio: [u32; 2], phase: f64) -> NormalOscillation {
    NormalOscillation { amplitude, frequency_ratio, phase }
}

struct Seeded(ChaCha8Rng);

impl Seeded {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Corners anywhere in a box, lifted or not.
    fn polygon(&mut self, corners: usize, transverse: f64, lift: f64) -> Path {
        let mut points: Vec<PathPoint> = (0..corners)
            .map(|_| PathPoint {
                tangential: [self.between(-1.0, 2.0), transverse * self.between(-1.0, 1.5)],
                lift: lift * self.between(0.0, 1.0),
            })
            .collect();
        points[corners / 2].lift = 0.0;
        Path { points }
    }
}

#[test]
fn resolved_cycles_are_the_closed_form_of_plain_oscillation_for_any_number_of_substeps() {
    let amplitude = 2.0;
    let mut worst = 0.0_f64;
    for law in laws() {
        for substeps in [2, 3, 7, 64, 501] {
            let path = sampled(&Tangential, amplitude, substeps);
            assert_eq!(path.points.len(), substeps);
            for compression in [0.0, 1e-12, 0.3, 1.1, 2.3, 2.7, 3.3, 4.6] {
                let found = cycle(&path, law, compression);
                let (sigma, _) = slip_amplitude_of_spring(law, M, amplitude, compression);
                let slip: f64 = found.slip.iter().map(|slip| slip[0].abs()).sum();
                let force = law.kinetic_strength(compression);
                let jump = law.static_strength(compression) - force;
                let jump_loss = if sigma > 0.0 { jump * jump / M } else { 0.0 };
                let errors = [
                    (slip - 4.0 * sigma) / amplitude,
                    (found.slip_path - 4.0 * sigma) / amplitude,
                    (found.dissipation - 4.0 * force * sigma) / amplitude,
                    (found.jump_loss - jump_loss) / amplitude,
                    (found.work - found.dissipation - found.jump_loss) / amplitude,
                ];
                let error = errors.iter().fold(0.0_f64, |worst, error| worst.max(error.abs()));
                worst = worst.max(error);
                assert!(error < 1e-13, "{law:?}, {substeps} substeps, q = {compression}: {errors:?}");
            }
        }
    }
    println!("largest error {worst:e}");
}

#[test]
fn the_derivative_of_slip_by_compression_is_that_of_differences() {
    for law in laws() {
        for compression in [0.4, 1.5] {
            let slip = |q: f64| slip_amplitude_of_spring(law, M, 2.0, q).0;
            let step = 1e-5;
            let differences = (slip(compression + step) - slip(compression - step)) / (2.0 * step);
            let (_, slope) = slip_amplitude_of_spring(law, M, 2.0, compression);
            assert!((slope / differences - 1.0).abs() < 1e-9, "{law:?}: {slope}, {differences}");
        }
        assert_eq!(slip_amplitude_of_spring(law, M, 2.0, 1e3), (0.0, 0.0));
        assert_eq!(slip_amplitude_of_spring(law, M, 2.0, -1.0), (2.0, -0.0));
    }
}

#[test]
fn work_of_the_indenter_is_what_friction_and_jumps_take_on_any_path() {
    let mut random = Seeded::new(7);
    let mut worst = [0.0_f64; 2];
    let (mut slipping, mut unfinished) = (0, 0);
    let mut longest = 0;
    for run in 0..4000 {
        let law = laws()[run % 4];
        let plane = run / 4 % 2;
        let lift = [0.0, 0.8, 3.0][run / 8 % 3];
        let path = random.polygon(2 + run % 11, plane as f64, lift);
        let compression = random.between(0.0, 4.0);
        let found = cycle(&path, law, compression);
        assert_eq!(found.slip.len(), path.points.len());
        if found.periods == Shakedown::default().max_periods {
            unfinished += 1;
        } else if found.slip_path > 0.0 {
            slipping += 1;
            longest = longest.max(found.periods);
            let error = (found.work - found.dissipation - found.jump_loss).abs() / found.work;
            let net = found.slip.iter().fold([0.0_f64; 2], |sum, slip| [sum[0] + slip[0], sum[1] + slip[1]]);
            // What slips has come back after a period, the deflection being the same; lifted springs move freely.
            let closes = path.largest_lift() > compression || net[0].abs().max(net[1].abs()) < 1e-11;
            worst[plane] = worst[plane].max(error);
            assert!(
                error < 3e-12 && closes,
                "{law:?}, q = {compression}, {path:?}: work {}, error {error:e}, net slip {net:?}",
                found.work
            );
            assert!(found.dissipation > 0.0, "{law:?}, q = {compression}: {}", found.dissipation);
        }
    }
    println!("{slipping} springs slip, {unfinished} unfinished, errors {worst:?}, at most {longest} periods");
    assert!(slipping > 2000 && unfinished < 20, "{slipping}, unfinished {unfinished}");
}

#[test]
fn deflections_stay_within_their_limits_and_slip_follows_the_force() {
    let mut random = Seeded::new(11);
    for run in 0..2000 {
        let law = laws()[run % 4];
        let path = random.polygon(3 + run % 9, 1.0, [0.0, 2.0][run / 4 % 2]);
        let compression = random.between(0.5, 3.0);
        let found = cycle(&path, law, compression);
        for (i, deflection) in found.deflection.iter().enumerate() {
            let end = path.points[(i + 1) % path.points.len()];
            let limit = law.static_strength(compression - end.lift) / M;
            let size = deflection[0].hypot(deflection[1]);
            assert!(size <= limit + 1e-14, "{law:?}, substep {i}: |e| = {size}, limit {limit}");
            let kinetic = law.kinetic_strength(compression - end.lift) / M;
            let slip = found.slip[i];
            // Slip within a substep turns with the force, and less than it by half a turn.
            let along = slip[0] * deflection[0] + slip[1] * deflection[1];
            if law.coefficient().is_some() && slip != [0.0; 2] && kinetic > 0.0 {
                assert!((size / kinetic - 1.0).abs() < 1e-12, "{law:?}: {size}, {kinetic}");
                assert!(along > 0.0, "{law:?}, substep {i}: slip {slip:?}, deflection {deflection:?}");
            }
        }
    }
}

#[test]
fn springs_stick_from_the_compression_of_the_smallest_circle_on() {
    let mut cases = vec![];
    for phase in [0.3, 1.2, FRAC_PI_2, 2.5, -1.0] {
        for ratio in [[1, 1], [2, 1], [1, 2], [3, 2], [5, 3]] {
            cases.push((format!("{ratio:?} phase {phase}"), sampled(&normal(0.4, ratio, phase), 1.5, 60)));
            // Lift decides: springs just below it are lifted off.
            cases.push((
                format!("lifted {ratio:?} phase {phase}"),
                sampled(&normal(3.0, ratio, phase), 0.5, 60),
            ));
        }
    }
    for (transverse_amplitude, centre) in
        [(0.5, [0.0; 2]), (2.5, [0.0; 2]), (0.7, [0.4, -0.3]), (1.2, [3.0, 1.0])]
    {
        for phase in [0.0, 0.7] {
            let mode = Orbit { transverse_amplitude, phase, centre };
            cases.push((format!("{mode:?}"), sampled(&mode, 1.5, 40)));
        }
    }
    let mut random = Seeded::new(3);
    for run in 0..40 {
        let lift = [0.0, 0.5][run % 2];
        cases.push((format!("polygon {run}"), random.polygon(3 + run % 8, (run / 2 % 2) as f64, lift)));
    }
    cases.push(("plain".to_owned(), sampled(&Tangential, 1.5, 2)));
    for (name, path) in cases {
        // In one direction a spring has shaken down after a period; in two it approaches rest the slower the nearer it is to the edge.
        let plane = path.points.iter().any(|point| point.tangential[1] != 0.0);
        for law in laws() {
            let edge = stick_compression(&path, law, M);
            if edge > 0.0 {
                let below = cycle(&path, law, edge * (1.0 - 1e-7)).slip_path;
                assert!(below > 0.0, "{name}, {law:?}: q* = {edge}, just below no slip");
            }
            let next = if plane { 1e-2 } else { 1e-7 };
            let step = 0.05 * edge.max(path.largest_lift());
            for level in 0..40 {
                let compression = edge * (1.0 + next) + step * f64::from(level);
                let slip = cycle(&path, law, compression).slip_path;
                let free = compression == 0.0;
                assert!(free || slip == 0.0, "{name}, {law:?}: q* = {edge}, at {compression} slip {slip}");
            }
        }
    }
}

/// Below the stick compression a spring repeats one motion whatever it did before, so that Newton's method finds what passing period after period comes to. Slip next to rest comes to it slowly.
#[test]
fn what_a_spring_that_slips_for_ever_repeats_is_found_by_newtons_method() {
    let mut random = Seeded::new(29);
    let (mut compared, mut passed) = (0, [0, 0]);
    for run in 0..60 {
        let path = random.polygon(3 + run % 8, 1.0, [0.0, 0.2, 0.5][run % 3]);
        for law in laws().into_iter().filter(|law| !law.remembers_slip()) {
            let edge = stick_compression(&path, law, M);
            for level in [0.2, 0.5, 0.8, 0.95, 0.999] {
                let found = [false, true].map(|slips| {
                    let mut out = SpringCycle::default();
                    let shakedown = Shakedown { max_periods: 100_000, slips, ..Shakedown::default() };
                    steady_cycle(&path, law, M, level * edge, &shakedown, &mut out);
                    out
                });
                let [by_periods, by_newton] = found.each_ref().map(|it| it.slip_path);
                let off = (by_newton - by_periods).abs() / by_periods;
                assert!(off < 1e-8, "{run}, {law:?}, {level} of q*: {by_newton}, {by_periods}");
                passed = [0, 1].map(|i| passed[i] + found[i].substeps);
                compared += 1;
            }
        }
    }
    println!("{compared} springs, substeps {passed:?}");
    assert!(3 * passed[1] < passed[0]);
}

/// With a static coefficient a spring may repeat one of several motions: it has to be that to which its own periods lead, which a path of so many periods in a row follows.
#[test]
fn what_a_spring_that_jumps_in_each_period_repeats_is_that_of_four_hundred_periods() {
    let mut random = Seeded::new(53);
    let (mut jump, mut passed, mut alternate) = (0, 0, 0);
    for run in 0..600 {
        let points = match run % 3 {
            0 => random.polygon(3 + run % 8, 1.0, 0.5).points,
            _ => {
                let (around, phase, lift) =
                    (random.between(0.02, 0.6), random.between(0.0, TAU), random.between(0.0, 0.3));
                let lifts = |angle: f64| lift * (1.0 - (2.0 * angle).sin());
                let at = |angle: f64| PathPoint {
                    tangential: [angle.cos(), around * (angle + phase).sin()],
                    lift: lifts(angle),
                };
                (0..96).map(|i| at(TAU * f64::from(i) / 96.0)).collect()
            }
        };
        let law = StaticKinetic { static_coefficient: 0.5, kinetic_coefficient: random.between(0.46, 0.49) };
        let compression = random.between(1.2, 1.6);
        let found = cycle(&Path { points: points.clone() }, &law, compression);
        let periods = 400;
        let many = Path { points: points.repeat(periods) };
        let mut out = SpringCycle::default();
        let once = Shakedown { max_periods: 0, ..Shakedown::default() };
        steady_cycle(&many, &law, M, compression, &once, &mut out);
        if found.periods == Shakedown::default().max_periods {
            // It repeats nothing.
            continue;
        }
        alternate += usize::from(found.alternates > 1);
        let last = &out.slip[out.slip.len() - found.alternates * points.len()..];
        for (i, got) in found.slip.iter().enumerate() {
            for axis in [0, 1] {
                let all = last.iter().skip(i).step_by(points.len()).map(|it| it[axis]);
                let expected = all.sum::<f64>() / found.alternates as f64;
                let off = (expected - got[axis]).abs();
                assert!(
                    off < 1e-9,
                    "{run}, {i}: {got:?} for {expected}, {compression}, {law:?} {}",
                    found.periods
                );
            }
        }
        let gone = (found.work - found.dissipation - found.jump_loss).abs();
        assert!(gone < 1e-11 * found.work.abs().max(1.0), "{run}: {gone} of {}", found.work);
        if found.jump_loss > 0.0 {
            jump += 1;
            passed += found.substeps / points.len();
        }
    }
    println!("{jump} springs, periods {passed}, {alternate} alternate");
    assert!(jump > 500 && passed < 12 * jump && alternate > 0);
}

#[test]
fn no_other_centre_beats_that_of_the_smallest_circle() {
    let mut random = Seeded::new(5);
    let mut worst = 0.0_f64;
    for run in 0..200 {
        let path = random.polygon(2 + run % 9, 1.0, [0.0, 0.3, 2.0][run % 3]);
        for law in [laws()[0], laws()[2], laws()[3]] {
            let edge = stick_compression(&path, law, M);
            let needed = |a: [f64; 2]| {
                path.points.iter().fold(0.0_f64, |needed, point| {
                    let [x, y] = [point.tangential[0] - a[0], point.tangential[1] - a[1]];
                    needed.max(law.compression_at(M * x.hypot(y)) + point.lift)
                })
            };
            // The least in y is quasi-convex in x.
            let best = lowest(|x| lowest(|y| needed([x, y])));
            worst = worst.max((best / edge - 1.0).abs());
            assert!(worst < 2e-14, "{law:?}, {path:?}: {edge}, found {best}");
        }
    }
    println!("largest difference {worst:e}");
}

/// Least value of a quasi-convex function between -1 and 2, by golden section.
fn lowest(function: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    let (mut low, mut high) = (-1.0, 2.0);
    let (mut a, mut b) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_a, mut at_b) = (function(a), function(b));
    for _ in 0..70 {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - golden * (high - low);
            at_a = function(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + golden * (high - low);
            at_b = function(b);
        }
    }
    at_a.min(at_b)
}

#[test]
fn one_frequency_in_phase_does_not_slip_at_all_below_its_amplitude() {
    let (amplitude, d1) = (1.5, 2.0);
    // μ_f = 0.45, M U = 1.2: nothing slips if μ_f d_1 > 1.2
    for (factor, sticks) in [(1.6, true), (1.4, true), (0.7, false)] {
        let path = sampled(&normal(factor * d1, [1, 1], 0.0), amplitude, 120);
        let law = coulomb(0.45);
        let slips: Vec<f64> = [1e-9, 1e-3, 0.3, 1.0, 2.0]
            .iter()
            .map(|q| cycle(&path, &law, q * factor * d1).slip_path)
            .collect();
        let edge = stick_compression(&path, &law, M);
        println!("d_1 = {}: {slips:?}, q* = {edge}", factor * d1);
        assert_eq!(slips.iter().take(4).all(|&slip| slip == 0.0), sticks, "{slips:?}");
        assert_eq!(edge == 0.0, sticks, "{edge}");
    }
}

#[test]
fn springs_near_a_peak_at_a_reversal_never_slip_if_the_normal_oscillation_is_strong() {
    // d = d_0 + d_1 cos 2ωt with r = M U/μ_f < 4 d_1: slip only between 2 d_1 - r²/(8 d_1) and 2 d_1 + r²/(8 d_1)
    let (amplitude, d1) = (1.5, 1.0);
    let law = coulomb(0.45);
    let r = M * amplitude / 0.45;
    let path = sampled(&normal(d1, [2, 1], 0.0), amplitude, 400);
    let band = [2.0 * d1 - r * r / (8.0 * d1), 2.0 * d1 + r * r / (8.0 * d1)];
    for compression in [1e-9, 1e-6, 1e-3, 0.1, 0.5, band[0] - 0.01, band[1] + 0.01] {
        assert_eq!(cycle(&path, &law, compression).slip_path, 0.0, "q = {compression}, band {band:?}");
    }
    for compression in [band[0] + 0.01, 2.0, band[1] - 0.01] {
        let slip = cycle(&path, &law, compression).slip_path;
        assert!(slip > 1e-4, "q = {compression}, band {band:?}: {slip}");
    }
    let edge = stick_compression(&path, &law, M);
    assert!((edge / band[1] - 1.0).abs() < 2e-4, "{edge}, {band:?}");
    // Weak enough, those nearest to the peak slip, and so do all others that stick nowhere.
    let weak = sampled(&normal(0.9 * r / 4.0, [2, 1], 0.0), amplitude, 400);
    for compression in [1e-6, 1e-3, 0.1] {
        assert!(cycle(&weak, &law, compression).slip_path > 0.0, "q = {compression}");
    }
}

#[test]
fn orbits_stick_from_their_larger_amplitude_on_wherever_they_are() {
    for (x, y) in [(1.5, 0.2), (1.0, 1.0), (0.7, 1.9)] {
        for (phase, centre) in [(0.0, [0.0; 2]), (0.0, [0.3, -2.0])] {
            let path = sampled(&Orbit { transverse_amplitude: y, phase, centre }, x, 37);
            let edge = stick_compression(&path, &coulomb(0.45), M);
            let exact = M * f64::max(x, y) / 0.45;
            assert!((edge / exact - 1.0).abs() < 1e-14, "{x}, {y}: {edge}, {exact}");
        }
    }
    // A phase turns the axes: U_x = U_y = 1 shifted by φ has the larger half axis √(1 + |sin φ|).
    let mode = Orbit { transverse_amplitude: 1.0, phase: 0.7, centre: [0.0; 2] };
    let edge = stick_compression(&sampled(&mode, 1.0, 12), &coulomb(0.45), M);
    let exact = M * (1.0 + 0.7_f64.sin()).sqrt() / 0.45;
    assert!((edge / exact - 1.0).abs() < 1e-14, "{edge}, {exact}");
}

#[test]
fn static_friction_holds_what_never_slipped_and_kinetic_friction_what_did() {
    let (static_coefficient, kinetic_coefficient) = (0.6, 0.2);
    let law = StaticKinetic { static_coefficient, kinetic_coefficient };
    let line = |low: f64, high: f64| Path {
        points: [low, high]
            .map(|x| PathPoint { tangential: [x, 0.0], lift: 0.0 })
            .into_iter()
            .collect::<Vec<_>>(),
    };
    // Pressed on in the middle: M U/μ_s.
    let centred = stick_compression(&line(-1.5, 1.5), &law, M);
    assert!((centred / (M * 1.5 / 0.6) - 1.0).abs() < 1e-12, "{centred}");
    // Far from it, all slip on the way there; the stroke is borne from μ_k on one side to μ_s on the other.
    let far = stick_compression(&line(7.0, 10.0), &law, M);
    assert!((far / (M * 3.0 / 0.8) - 1.0).abs() < 1e-12, "{far}");
    // Only just off the middle, that the spring bears from its first position is still the easier.
    let near = stick_compression(&line(-1.0, 2.0), &law, M);
    assert!((near / (M * 2.0 / 0.6) - 1.0).abs() < 1e-12, "{near}");
}

/// Slip in the last of some cycles to and fro, m, of a spring that is followed in small steps through one amplitude after the other.
fn slip_after(amplitudes: &[f64], law: &StaticKinetic, compression: f64) -> f64 {
    let [held, dragged] =
        [law.static_coefficient, law.kinetic_coefficient].map(|coefficient| coefficient * compression / M);
    let (mut place, mut deflection, mut sliding, mut slip) = (0.0, 0.0_f64, 0.0, 0.0);
    for amplitude in amplitudes {
        slip = 0.0;
        for target in [*amplitude, -amplitude] {
            let step = 1e-4_f64.copysign(target - place);
            let count = ((target - place) / step).round() as usize;
            for _ in 0..count {
                if sliding != step.signum() {
                    sliding = 0.0;
                }
                let moved = deflection + step;
                let limit = if sliding == 0.0 { held } else { dragged };
                if moved.abs() > limit {
                    sliding = moved.signum();
                    slip += (moved - sliding * dragged).abs();
                    deflection = sliding * dragged;
                } else {
                    deflection = moved;
                }
            }
            place = target;
        }
    }
    slip
}

/// Moved less far than before, a spring slips on as long as it comes from the kinetic limit on one side to the static one on the other, `2 M U > (μ_s + μ_k) q`.
#[test]
fn a_spring_that_has_slipped_goes_on_to_down_to_the_mean_of_both_limits() {
    let law = StaticKinetic { static_coefficient: 0.6, kinetic_coefficient: 0.4 };
    let (before, now) = (1.0, 0.8);
    let path = sampled(&Tangential, now, 12);
    let [fresh, mean, slipped] = [M * now / 0.6, M * now / 0.5, M * before / 0.6];
    assert!(fresh < mean && mean < slipped);
    for (compression, slips) in [
        (0.99 * fresh, true),
        (1.01 * fresh, true),
        (0.99 * mean, true),
        (1.01 * mean, false),
        (0.99 * slipped, false),
    ] {
        let expected = slip_after(&[before, before, now, now, now], &law, compression);
        let mut found = SpringCycle::default();
        settled_cycle(&path, &law, M, [compression, slipped], &Shakedown::default(), &mut found);
        assert_eq!(expected > 0.0, slips, "{compression}: {expected}");
        assert!((found.slip_path - expected).abs() < 1e-3, "{compression}: {}, {expected}", found.slip_path);
    }
    for (slipped, edge) in [(slipped, mean), (0.5 * (fresh + mean), 0.5 * (fresh + mean)), (0.0, fresh)] {
        let found = searched_stick_compression(&path, &law, M, slipped).0;
        assert!((found / edge - 1.0).abs() < 1e-12, "{slipped}: {found}, {edge}");
    }
}

#[test]
fn a_spring_dragged_round_a_circle_is_second_order_in_the_substeps() {
    // The slip goes round a circle of radius √(U² - l²), the deflection at right angles to it.
    let (amplitude, compression) = (1.5, 1.6);
    let law = coulomb(0.45);
    let limit = 0.45 * compression / M;
    let exact = TAU * (amplitude * amplitude - limit * limit).sqrt();
    let mode = Orbit { transverse_amplitude: amplitude, phase: 0.0, centre: [0.2, -0.1] };
    let errors: Vec<[f64; 2]> = [16, 32, 64, 128]
        .iter()
        .map(|&substeps| {
            let found = cycle(&sampled(&mode, amplitude, substeps), &law, compression);
            [found.slip_path / exact - 1.0, found.dissipation / (0.45 * compression * exact) - 1.0]
        })
        .collect();
    println!("{errors:?}");
    for quantity in [0, 1] {
        let order = (errors[0][quantity] / errors[3][quantity]).log2() / 3.0;
        assert!((order - 2.0).abs() < 0.05, "{errors:?}: order {order}");
    }
    assert!(errors[2][0].abs() < 5e-3, "{errors:?}");
}

#[test]
fn normal_oscillation_is_second_order_in_the_substeps() {
    let mode = normal(1.0, [1, 1], 0.9);
    let law = coulomb(0.45);
    for compression in [0.05, 0.5, 1.7] {
        let slip = |substeps: usize| cycle(&sampled(&mode, 1.5, substeps), &law, compression).slip_path;
        let exact = slip(40_001);
        // Errors depend on where within a substep the spring touches; the worst of a few is what converges.
        let errors: Vec<f64> = [80, 160, 320, 640]
            .iter()
            .map(|&n| (0..8).map(|i| (slip(n + n * i / 10) / exact - 1.0).abs()).fold(0.0, f64::max))
            .collect();
        let order = (errors[0] / errors[3]).log2() / 3.0;
        println!("q = {compression}: {errors:?}, order {order:.2}");
        assert!(order > 1.8, "q = {compression}: {errors:?}, order {order}");
        assert!(errors[1] < 1e-2, "q = {compression}: {errors:?}");
    }
}

#[test]
fn springs_loaded_only_next_to_the_peak_slip_as_far_as_the_indenter_moves() {
    // Loaded for |t| < √(2 ε/d_1), while u moves at the speed it has at the peak, U sin φ: slip 2 U sin(φ) √(2 ε/d_1).
    let (amplitude, phase) = (1.5, 0.9);
    let path = sampled(&normal(1.0, [1, 1], phase), amplitude, 160);
    let mut worst = 0.0_f64;
    for exponent in 4..=9 {
        for mantissa in [1.0, 2.0, 5.0] {
            let compression = mantissa * 10_f64.powi(-exponent);
            let exact = 2.0 * amplitude * phase.sin() * (2.0 * compression).sqrt();
            let found = cycle(&path, &coulomb(0.45), compression).slip_path;
            worst = worst.max((found / exact - 1.0).abs());
            println!("ε = {compression:e}: {:e}", found / exact - 1.0);
        }
    }
    assert!(worst < 5e-2, "{worst:e}");
}

#[test]
fn slip_without_compression_is_the_whole_path() {
    let mut random = Seeded::new(13);
    for law in laws() {
        for transverse in [0.0, 1.0] {
            let path = random.polygon(9, transverse, 0.0);
            let lengths = [1e-3, 1e-6, 1e-9, 0.0].map(|q| cycle(&path, law, q).slip_path / path.length());
            assert!((lengths[3] - 1.0).abs() < 1e-14, "{law:?}: {lengths:?}");
            assert!((lengths[2] - 1.0).abs() < 1e-4 && lengths[0] < lengths[1], "{law:?}: {lengths:?}");
        }
    }
}

#[test]
fn springs_that_are_lifted_neither_slip_nor_pull() {
    let path = sampled(&normal(1.0, [1, 1], 0.9), 1.5, 80);
    let found = cycle(&path, &coulomb(0.45), 0.5);
    let n = path.points.len();
    let lifted: Vec<usize> =
        (0..n).filter(|&i| path.points[i].lift > 0.5 && path.points[(i + 1) % n].lift > 0.5).collect();
    assert!(lifted.len() > n / 4, "{}", lifted.len());
    for i in lifted {
        assert_eq!((found.slip[i], found.deflection[i]), ([0.0; 2], [0.0; 2]), "substep {i}");
    }
    let never = cycle(&path, &coulomb(0.45), -1e-3);
    assert_eq!((never.slip_path, never.dissipation, never.work), (0.0, 0.0, 0.0));
}

#[test]
fn paths_contain_reversals_and_extrema_exactly() {
    for ratio in [[1, 1], [2, 1], [1, 2], [3, 2], [7, 4]] {
        for phase in [0.0, 0.3, FRAC_PI_2, PI, -2.0, 9.0] {
            for substeps in [2, 16, 77, 400] {
                let sampled = SampledPath::new(&normal(0.3, ratio, phase), 1.5, 10.0, substeps);
                let points = &sampled.path.points;
                let case = format!("{ratio:?}, φ = {phase}, {substeps} substeps");
                let count = |what: &dyn Fn(&PathPoint) -> bool| points.iter().filter(|p| what(p)).count();
                assert_eq!((sampled.largest_indentation, sampled.oscillations), (10.3, ratio[1]), "{case}");
                assert_eq!(points[0].tangential[0], 1.5, "{case}");
                assert_eq!(count(&|p| p.lift == 0.0), ratio[0] as usize, "{case}");
                assert_eq!(count(&|p| p.lift == 0.6), ratio[0] as usize, "{case}");
                for side in [1.5, -1.5] {
                    assert_eq!(count(&|p| p.tangential[0] == side), ratio[1] as usize, "{case}");
                }
                assert!(count(&|p| p.tangential[1] != 0.0 || p.lift < 0.0 || p.lift > 0.6) == 0, "{case}");
                // Between reversals the indenter goes one way.
                let turns = (0..points.len())
                    .filter(|&i| {
                        let n = points.len();
                        let [a, b, c] = [i, (i + 1) % n, (i + 2) % n].map(|i| points[i].tangential[0]);
                        (b - a) * (c - b) <= 0.0
                    })
                    .count();
                assert_eq!(turns, 2 * ratio[1] as usize, "{case}");
                assert!(points.len() <= substeps + 2 * (ratio[0] + 2 * ratio[1]) as usize, "{case}");
            }
        }
    }
}

#[test]
fn recorded_paths_keep_their_rows_and_are_cut_evenly() {
    let recorded = RecordedPath {
        source: "made up".to_owned(),
        x: vec![0.0, 1.0, 0.5, 0.0],
        y: vec![0.0, 0.5, -0.5, 0.0],
        indentation: vec![-0.1, 0.2, 0.1, -0.1],
    };
    let rows = 3;
    for substeps in [1, 3, 4, 12] {
        let sampled = SampledPath::new(&recorded, 9.0, 2.0, substeps);
        let parts = substeps.div_ceil(rows);
        assert_eq!(sampled.path.points.len(), rows * parts);
        assert_eq!(sampled.largest_indentation, 2.2);
        for row in 0..rows {
            let point = sampled.path.points[row * parts];
            assert_eq!(point.tangential, [recorded.x[row], recorded.y[row]]);
            assert_eq!(point.lift, 0.2 - recorded.indentation[row]);
        }
        // Cutting straight lines changes no deflection, however few the substeps.
        let whole = SampledPath::new(&recorded, 9.0, 2.0, 1).path;
        for law in laws().into_iter().take(2) {
            let [a, b] = [&whole, &sampled.path].map(|path| cycle(path, law, 0.6).deflection);
            for row in 0..rows {
                let [a, b] = [a[row], b[row * parts + parts - 1]];
                let error = (a[0] - b[0]).hypot(a[1] - b[1]);
                assert!(error < 1e-13, "{law:?}, {substeps} substeps, row {row}: {a:?}, {b:?}");
            }
        }
    }
}

#[test]
fn a_cycle_that_is_used_again_is_as_if_new() {
    let mut random = Seeded::new(17);
    let mut used = SpringCycle::default();
    for run in 0..40 {
        let path = random.polygon(3 + run % 7, (run % 2) as f64, 1.0);
        let law = laws()[run / 2 % 4];
        steady_cycle(&path, law, M, 1.3, &Shakedown::default(), &mut used);
        assert_eq!(used, cycle(&path, law, 1.3), "run {run}");
    }
}

#[test]
fn springs_along_a_line_stick_from_the_turns_of_what_pushes_them_on_however_few_the_substeps() {
    let law = coulomb(0.45);
    let slope = 0.45 / M;
    let mut random = Seeded::new(21);
    let (mut worst, mut without) = (0.0_f64, 0.0_f64);
    for frequency_ratio in [[1, 1], [2, 1], [3, 2], [1, 2]] {
        for _ in 0..6 {
            let mode = normal(random.between(0.02, 0.6), frequency_ratio, random.between(0.0, TAU));
            let amplitude = random.between(1.0, 3.0);
            // The slip lies between V+ - (μ_f/M) q and V- + (μ_f/M) q at all times, V± = u ± (μ_f/M) lift.
            let [over, under] = frequency_ratio.map(f64::from);
            let pushes = |time: f64, side: f64| {
                let lift = 2.0 * mode.amplitude * (0.5 * (over / under * time + mode.phase)).sin().powi(2);
                amplitude * time.cos() + side * slope * lift
            };
            let most = |sign: f64, side: f64| {
                let count = 20_000;
                let at = |i: f64| sign * pushes(TAU * under * i / f64::from(count), side);
                let best = (0..count).map(f64::from).max_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap();
                let [a, b, c] = [at(best - 1.0), at(best), at(best + 1.0)];
                b - (c - a).powi(2) / (8.0 * (a + c - 2.0 * b))
            };
            let exact = (most(1.0, 1.0) + most(-1.0, -1.0)) / (2.0 * slope);
            if exact <= 2.0 * mode.amplitude {
                continue;
            }
            for substeps in [12, 48, 192] {
                let path = SampledPath::with_turns(&mode, amplitude, 10.0, substeps, slope).path;
                worst = worst.max((stick_compression(&path, &law, M) / exact - 1.0).abs());
                let path = sampled(&mode, amplitude, substeps);
                without = without.max((stick_compression(&path, &law, M) / exact - 1.0).abs());
            }
        }
    }
    println!("edge of stick: {worst:e}, without the turns {without:e}");
    assert!(worst < 1e-11, "{worst:e}");
    assert!(without > 1e-3, "{without:e}");
}
