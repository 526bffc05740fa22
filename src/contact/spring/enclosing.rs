//! The smallest circle around circles.

use super::{difference, dot, length, scaled, square, sum};

/// Rounds of adding the circle that sticks out most; each raises the radius, and there are rarely more than ten.
const MAX_ROUNDS: usize = 1000;

/// Relative excess at which a circle counts as enclosed.
const ENCLOSED: f64 = 1e-15;

/// A circle; its radius may be negative, which is a point that may lie that far outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    pub centre: [f64; 2],
    pub radius: f64,
}

/// How far the circle reaches from `place`.
fn reach(circle: &Circle, place: [f64; 2]) -> f64 {
    length(difference(circle.centre, place)) + circle.radius
}

/// The furthest circle from `place`, and how far it reaches; the first of equals.
fn furthest(circles: &[Circle], place: [f64; 2]) -> (usize, f64) {
    let reaches = circles.iter().map(|circle| reach(circle, place)).enumerate();
    reaches.fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best })
}

/// The smallest circle that encloses all: `min over a of max (|c_i - a| + r_i)` and where it is.
///
/// At most three of them touch it. Those of a few are found among all choices of up to three, then the one that sticks out most is added to
/// the few, so the radius grows until nothing sticks out.
pub fn smallest_enclosing(circles: &[Circle]) -> Circle {
    let (first, _) = furthest(circles, circles[0].centre);
    let mut few = vec![circles[first]];
    let mut best = Circle { centre: [0.0; 2], radius: f64::INFINITY };
    let mut last_radius = f64::NEG_INFINITY;
    for _ in 0..MAX_ROUNDS {
        let (found, touching) = of_few(&few);
        let (out, radius) = furthest(circles, found.centre);
        if radius < best.radius {
            best = Circle { centre: found.centre, radius };
        }
        let enclosed = radius - found.radius <= ENCLOSED * radius.abs();
        if enclosed || found.radius <= last_radius {
            break;
        }
        last_radius = found.radius;
        few = touching;
        few.push(circles[out]);
    }
    best
}

/// The smallest circle around up to four, and those that it touches.
fn of_few(few: &[Circle]) -> (Circle, Vec<Circle>) {
    let mut best = (Circle { centre: [0.0; 2], radius: f64::INFINITY }, vec![]);
    for choice in 1_u32..1 << few.len() {
        if choice.count_ones() > 3 {
            continue;
        }
        let chosen: Vec<Circle> =
            few.iter().enumerate().filter(|(i, _)| choice >> i & 1 == 1).map(|(_, circle)| *circle).collect();
        let centre = match chosen[..] {
            [one] => Some(one.centre),
            [one, two] => centre_of_two(&one, &two),
            [one, two, three] => centre_of_three(&one, &two, &three),
            _ => None,
        };
        let Some(centre) = centre else { continue };
        let (_, radius) = furthest(few, centre);
        if radius < best.0.radius {
            best = (Circle { centre, radius }, chosen);
        }
    }
    best
}

fn centre_of_two(one: &Circle, two: &Circle) -> Option<[f64; 2]> {
    let way = difference(two.centre, one.centre);
    let distance = length(way);
    let part = 0.5 * (distance + two.radius - one.radius) / distance;
    (part > 0.0 && part < 1.0).then(|| sum(one.centre, scaled(part, way)))
}

/// Centre of the circle that touches three from outside of them: `|x| = s`, `|x - d_i| = s - δ_i` seen from the first.
fn centre_of_three(one: &Circle, two: &Circle, three: &Circle) -> Option<[f64; 2]> {
    let ways = [two, three].map(|other| difference(other.centre, one.centre));
    let deltas = [two, three].map(|other| other.radius - one.radius);
    let determinant = ways[0][0] * ways[1][1] - ways[0][1] * ways[1][0];
    // d_i·x = (|d_i|² - δ_i²)/2 + δ_i s, so x = α + β s
    let solve = |right: [f64; 2]| {
        let x = (right[0] * ways[1][1] - right[1] * ways[0][1]) / determinant;
        let y = (ways[0][0] * right[1] - ways[1][0] * right[0]) / determinant;
        [x, y]
    };
    let alpha = solve([0, 1].map(|i| 0.5 * (square(ways[i]) - deltas[i] * deltas[i])));
    let beta = solve(deltas);
    let (a, b, c) = (square(beta) - 1.0, dot(alpha, beta), square(alpha));
    let discriminant = b * b - a * c;
    if determinant == 0.0 || !discriminant.is_finite() || discriminant < 0.0 {
        return None;
    }
    let shared = -(b + discriminant.sqrt().copysign(b));
    let least = deltas[0].max(deltas[1]).max(0.0);
    let roots = [shared / a, c / shared];
    let s = roots.into_iter().filter(|s| s.is_finite() && *s >= least).reduce(f64::min)?;
    Some(sum(one.centre, sum(alpha, scaled(s, beta))))
}
