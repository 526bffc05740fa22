//! Plain transients of power-law indenters by a spectral method that shares neither mesh, nor operators, nor time stepping with the program.
//!
//! With `h = 1 - ξ`, `Z = a² - c²` and `B = c² + Z ξ`, in units in which the first contact radius, the indentation and the stiffness are one, so that
//! `q_0 = 1 - B^(n/2)`, the unknowns are `λ = ln(S/S_0)` at the inner nodes and `Z`. With `e = q_0 - q` and `b = B^(ν-1) e`
//!
//! ```text
//! S_0 expm1 λ = Z^(1-ν) F b,                    F b = sin(πν)/π ∫_0^ξ (ξ-η)^(-ν) b dη
//! p = p_0 - Z^(ν-1) P e,                        P e = -1/π ∫_ξ^1 (η-ξ)^(ν-1) e' dη
//! λ' - (ξ/ξ_y) λ_y Z'/Z = p,  λ = 0 at the edge,  e = q_0 there
//! V = Z^(2-ν) sin(πν)/(1-ν) ∫_0^1 h^(1-ν) b dξ
//! ```
//!
//! `λ` is `(1-y)^m` times a polynomial, `b` and `e` are a constant plus `(1-y)^j` times a polynomial, with `ξ = expm1(Λg)/expm1(Λ)` and `g = I_y(α+1, m)`,
//! on Gauss-Radau nodes of which the last is the contact edge and none the edge of stick. Time is stepped by Radau IIA of order 5 in even steps of `ln(1 + τ/τ_0)`.

use std::f64::consts::PI;

use faer::Mat;
use fretwear::numerics::linear::Factors;
use fretwear::numerics::quadrature::Rule;

/// Nodes of the rules for smooth integrands, and for the unworn contact.
const NODES: usize = 40;

/// Parts into which the smooth part of a singular integral is cut, each next to the singular end half as long as the one before.
const CUTS: i32 = 6;

/// A power law `A r^n` on a half-space of grading `k` with the stick radius `c`.
#[derive(Debug, Clone, Copy)]
pub struct Plain {
    pub grading: f64,
    pub exponent: f64,
    pub stick_ratio: f64,
}

/// `ξ(y)` and its derivative.
#[derive(Debug, Clone, Copy)]
struct Map {
    alpha: i32,
    edge: i32,
    stretch: f64,
}

/// A place: `1 - y`, `ξ`, `1 - ξ` and `dξ/dy`.
#[derive(Debug, Clone, Copy)]
struct Place {
    left: f64,
    value: f64,
    complement: f64,
    slope: f64,
}

impl Map {
    /// Those measured to serve best for a grading.
    fn of(grading: f64) -> Self {
        let (alpha, edge, stretch) = match grading {
            k if k <= -0.3 => (2, 3, 0.0),
            k if k >= 0.7 => (0, 2, 10.0),
            _ => (1, 2, 4.0),
        };
        Self { alpha, edge, stretch }
    }

    /// `∫_0^x t^a (1-t)^b dt` with whole `a` and `b`, by powers of the distance from the nearer end of what is asked for.
    fn incomplete(x: f64, a: i32, b: i32) -> f64 {
        let mut binomial = 1.0;
        let term = |j: i32| {
            let found = binomial * x.powi(a + 1 + j) / f64::from(a + 1 + j);
            binomial *= -f64::from(b - j) / f64::from(j + 1);
            found
        };
        (0..=b).map(term).sum()
    }

    fn at(&self, y: f64, left: f64) -> Place {
        let (a, b) = (self.alpha, self.edge - 1);
        let whole = Self::incomplete(1.0, a, b);
        let (g, rest) = match y < 0.5 {
            true => {
                let g = Self::incomplete(y, a, b) / whole;
                (g, 1.0 - g)
            }
            false => {
                let rest = Self::incomplete(left, b, a) / whole;
                (1.0 - rest, rest)
            }
        };
        let slope = y.powi(a) * left.powi(b) / whole;
        if self.stretch == 0.0 {
            return Place { left, value: g, complement: rest, slope };
        }
        let grown = self.stretch.exp_m1();
        Place {
            left,
            value: (self.stretch * g).exp_m1() / grown,
            complement: (self.stretch * g).exp() * (self.stretch * rest).exp_m1() / grown,
            slope: self.stretch * (self.stretch * g).exp() * slope / grown,
        }
    }
}

/// Cardinal functions `c_j(y)`: with `1 - y = v` a weight `v^power` times a polynomial, with a constant beside it or zero at the edge.
struct Basis {
    power: i32,
    constant: bool,
    /// `1 - y` of the nodes, the last one zero.
    left: Vec<f64>,
}

impl Basis {
    /// Values and derivatives by `y` of the polynomials `ℓ_j` on the inner nodes.
    fn lagrange(&self, left: f64) -> Vec<[f64; 2]> {
        let inner = &self.left[..self.left.len() - 1];
        let hit = inner.iter().position(|node| *node == left);
        let one = |j: usize| {
            let others = || inner.iter().enumerate().filter(move |(m, _)| *m != j);
            let factor = |node: &f64| (left - node) / (inner[j] - node);
            let value: f64 = others().map(|(_, node)| factor(node)).product();
            let slope: f64 = match hit {
                Some(at) if at != j => {
                    let rest = others().filter(|(m, _)| *m != at).map(|(_, node)| factor(node));
                    rest.product::<f64>() / (inner[j] - inner[at])
                }
                _ => value * others().map(|(_, node)| (left - node).recip()).sum::<f64>(),
            };
            // d/dy = -d/d(1-y).
            [value, -slope]
        };
        (0..inner.len()).map(one).collect()
    }

    /// Values and derivatives by `y` of the cardinal functions of all nodes.
    fn at(&self, left: f64) -> Vec<[f64; 2]> {
        let mut found: Vec<[f64; 2]> = self
            .lagrange(left)
            .into_iter()
            .zip(&self.left)
            .map(|([value, slope], node)| {
                let scale = node.powi(self.power);
                let weight = left.powi(self.power) / scale;
                let weight_slope = -f64::from(self.power) * left.powi(self.power - 1) / scale;
                [weight * value, weight_slope * value + weight * slope]
            })
            .collect();
        // What is one everywhere, less the others.
        let sum = found.iter().fold([0.0; 2], |sum, it| [sum[0] + it[0], sum[1] + it[1]]);
        found.push(if self.constant { [1.0 - sum[0], -sum[1]] } else { [0.0; 2] });
        found
    }
}

/// Points of a rule on a part of `y`, with weights that hold the kernel's singularity.
struct Points {
    places: Vec<Place>,
    weights: Vec<f64>,
}

/// The method on some nodes.
pub struct Spectral {
    plain: Plain,
    nu: f64,
    places: Vec<Place>,
    /// Of `F` on all nodes; `P`, and `ξ d/dξ` on the inner ones.
    profile: Factors,
    pressure: Mat<f64>,
    along: Mat<f64>,
    /// Weights of the volume.
    volume: Vec<f64>,
    /// For the slip depth and the pressure of the unworn contact.
    from_stick: Rule,
    to_edge: Rule,
}

/// `λ` at the inner nodes, then `Z`.
type State = Vec<f64>;

impl Spectral {
    pub fn new(plain: Plain, nodes: usize) -> Self {
        let nu = 0.5 * (1.0 + plain.grading);
        let map = Map::of(plain.grading);
        // Gauss-Radau with the node at the edge: zeros of the Jacobi polynomial of weight 1 - y.
        let radau = Rule::jacobi(nodes - 1, 1.0, 0.0).unwrap();
        let mut places: Vec<Place> =
            radau.nodes.iter().zip(&radau.complements).map(|(y, left)| map.at(*y, *left)).collect();
        places.push(Place { left: 0.0, value: 1.0, complement: 0.0, slope: 0.0 });
        let left: Vec<f64> = places.iter().map(|place| place.left).collect();
        let smallest = (f64::from(map.edge) * (1.0 - nu)).ceil() as i32;
        let power = if plain.grading > 0.0 { map.edge } else { smallest };
        let carried = Basis { power, constant: true, left: left.clone() };
        let logarithm = Basis { power: map.edge, constant: false, left };
        let n = places.len();
        let mut profile = Mat::zeros(n, n);
        let mut pressure = Mat::zeros(n, n);
        for (i, place) in places.iter().enumerate() {
            let points = inwards(&map, place, nu);
            for (point, weight) in points.places.iter().zip(&points.weights) {
                for (j, [value, _]) in carried.at(point.left).iter().enumerate() {
                    profile[(i, j)] += (PI * nu).sin() / PI * weight * value;
                }
            }
            if i + 1 < n {
                let points = outwards(&map, place, nu);
                for (point, weight) in points.places.iter().zip(&points.weights) {
                    for (j, [_, slope]) in carried.at(point.left).iter().enumerate() {
                        pressure[(i, j)] -= weight * slope / PI;
                    }
                }
            }
        }
        let along = Mat::from_fn(n - 1, n - 1, |i, j| {
            places[i].value / places[i].slope * logarithm.at(places[i].left)[j][1]
        });
        // ∫ h^(1-ν) b dξ: at the edge h is the power m of 1 - y.
        let power = f64::from(map.edge) * (2.0 - nu) - 1.0;
        let rule = Rule::jacobi(NODES, power, f64::from(map.alpha)).unwrap();
        let total = beta(power + 1.0, f64::from(map.alpha) + 1.0);
        let mut volume = vec![0.0; n];
        for ((y, left), weight) in rule.nodes.iter().zip(&rule.complements).zip(&rule.weights) {
            let place = map.at(*y, *left);
            let density =
                place.complement.powf(1.0 - nu) * place.slope / (left.powf(power) * y.powi(map.alpha));
            for (sum, [value, _]) in volume.iter_mut().zip(carried.at(*left)) {
                *sum += total * weight * density * value;
            }
        }
        Self {
            plain,
            nu,
            places,
            profile: Factors::new(profile),
            pressure,
            along,
            volume,
            from_stick: Rule::jacobi(NODES, -nu, 1.0).unwrap(),
            to_edge: Rule::jacobi(NODES, 0.0, nu - 1.0).unwrap(),
        }
    }

    /// `S_0` at `B = c² + z`.
    fn unworn(&self, z: f64) -> f64 {
        let (nu, half) = (self.nu, 0.5 * self.plain.exponent);
        let stick = self.plain.stick_ratio.powi(2);
        let mean = self.from_stick.mean(|v| {
            let s = stick + z * v;
            // s^(n/2) - c^n over v.
            s.powf(nu - 1.0) * stick.powf(half) * (half * (z * v / stick).ln_1p()).exp_m1() / v
        });
        (PI * nu).sin() / PI * z.powf(1.0 - nu) * beta(1.0 - nu, 2.0) * mean
    }

    /// `p_0` at a place.
    fn unworn_pressure(&self, z: f64, place: &Place) -> f64 {
        let (nu, half) = (self.nu, 0.5 * self.plain.exponent);
        let (inner, width) = (self.plain.stick_ratio.powi(2) + z * place.value, z * place.complement);
        let mean = self.to_edge.mean(|v| half * (inner + width * v).powf(half - 1.0));
        width.powf(nu) * mean / (PI * nu)
    }

    /// `S_0` at all nodes and `p_0` at the inner ones.
    fn unworn_at(&self, z: f64) -> [Vec<f64>; 2] {
        let inner = &self.places[..self.places.len() - 1];
        [
            self.places.iter().map(|place| self.unworn(z * place.value)).collect(),
            inner.iter().map(|place| self.unworn_pressure(z, place)).collect(),
        ]
    }

    /// `b` that carries the wear of a state.
    fn carried(&self, state: &State, slip: &[f64]) -> Vec<f64> {
        let scale = state[state.len() - 1].powf(self.nu - 1.0);
        let mut depth: Vec<f64> =
            slip.iter().zip(state).map(|(slip, log)| slip * log.exp_m1() * scale).collect();
        *depth.last_mut().unwrap() = 0.0;
        self.profile.solve(&mut depth);
        depth
    }

    /// Pressures at the inner nodes, and what is left of the constraint at the edge.
    fn pressures(&self, state: &State, [slip, pressure]: &[Vec<f64>; 2]) -> (Vec<f64>, f64) {
        let z = state[state.len() - 1];
        let stick = self.plain.stick_ratio.powi(2);
        let carried = self.carried(state, slip);
        let raised: Vec<f64> = carried
            .iter()
            .zip(&self.places)
            .map(|(b, place)| b * (stick + z * place.value).powf(1.0 - self.nu))
            .collect();
        let scale = z.powf(self.nu - 1.0);
        let worn = |(i, unworn): (usize, &f64)| {
            let sum: f64 = raised.iter().enumerate().map(|(j, e)| self.pressure[(i, j)] * e).sum();
            unworn - scale * sum
        };
        let last = raised[raised.len() - 1];
        let unworn = 1.0 - (stick + z).powf(0.5 * self.plain.exponent);
        (pressure.iter().enumerate().map(worn).collect(), last - unworn)
    }

    /// Worn volume over `a0² d`.
    pub fn worn_volume(&self, state: &State) -> f64 {
        let z = state[state.len() - 1];
        let sum: f64 = self
            .volume
            .iter()
            .zip(self.carried(state, &self.unworn_at(z)[0]))
            .map(|(weight, b)| weight * b)
            .sum();
        z.powf(2.0 - self.nu) * (PI * self.nu).sin() / (1.0 - self.nu) * sum
    }

    /// Contact radius over the first one.
    pub fn contact_radius(&self, state: &State) -> f64 {
        (self.plain.stick_ratio.powi(2) + state[state.len() - 1]).sqrt()
    }

    /// What is left of the equations of a stage with some rates.
    fn residual(&self, state: &State, unworn: &[Vec<f64>; 2], rate: &State) -> State {
        let inner = state.len() - 1;
        let (pressure, edge) = self.pressures(state, unworn);
        let moved = rate[inner] / state[inner];
        let mut left: State = (0..inner)
            .map(|i| {
                let along: f64 = (0..inner).map(|j| self.along[(i, j)] * state[j]).sum();
                rate[i] - along * moved - pressure[i]
            })
            .collect();
        left.push(edge);
        left
    }

    /// One step of Radau IIA, three stages of order 5 (Hairer and Wanner, Solving Ordinary Differential Equations II, ch. IV.5), from a guess of the
    /// rates in its stages; none if they are not found.
    fn step(&self, state: &State, step: f64, guess: &mut [State; 3]) -> Option<State> {
        let n = state.len();
        let root = 6.0_f64.sqrt();
        let a = [
            [(88.0 - 7.0 * root) / 360.0, (296.0 - 169.0 * root) / 1800.0, (-2.0 + 3.0 * root) / 225.0],
            [(296.0 + 169.0 * root) / 1800.0, (88.0 + 7.0 * root) / 360.0, (-2.0 - 3.0 * root) / 225.0],
            [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
        ];
        let stage = |i: usize, rates: &[State; 3]| -> State {
            let sum = |l: usize| (0..3).map(|j| a[i][j] * rates[j][l]).sum::<f64>();
            (0..n).map(|l| state[l] + step * sum(l)).collect()
        };
        let mut factors = None;
        let mut before = f64::INFINITY;
        for iteration in 0..40 {
            let at = |i: usize| {
                let state = stage(i, guess);
                let unworn = self.unworn_at(state[n - 1]);
                (state, unworn)
            };
            let stages: [_; 3] = std::array::from_fn(at);
            let residuals: Vec<f64> =
                (0..3).flat_map(|i| self.residual(&stages[i].0, &stages[i].1, &guess[i])).collect();
            if iteration % 4 == 0 {
                let mut matrix = Mat::zeros(3 * n, 3 * n);
                for i in 0..3 {
                    let ((at, unworn), rate) = (&stages[i], &guess[i]);
                    let here = &residuals[i * n..(i + 1) * n];
                    for l in 0..n {
                        let small = 1e-7 * if l + 1 == n { at[l] } else { at[l].abs().max(1e-3) };
                        let (mut moved, mut faster) = (at.clone(), rate.clone());
                        moved[l] += small;
                        let edge = (l + 1 == n).then(|| self.unworn_at(moved[l]));
                        let by_state = self.residual(&moved, edge.as_ref().unwrap_or(unworn), rate);
                        let quick = rate[l].abs().max(1.0);
                        faster[l] += quick;
                        let by_rate = self.residual(at, unworn, &faster);
                        for row in 0..n {
                            let slope = (by_state[row] - here[row]) / small;
                            for j in 0..3 {
                                matrix[(i * n + row, j * n + l)] += slope * step * a[i][j];
                            }
                            matrix[(i * n + row, i * n + l)] += (by_rate[row] - here[row]) / quick;
                        }
                    }
                }
                factors = Some(Factors::new(matrix));
            }
            let mut change = residuals;
            factors.as_ref().unwrap().solve(&mut change);
            let mut size = 0.0_f64;
            for (i, rates) in guess.iter_mut().enumerate() {
                for (l, rate) in rates.iter_mut().enumerate() {
                    *rate -= change[i * n + l];
                    let part = (step * change[i * n + l]).abs();
                    size = if part.is_finite() { size.max(part) } else { f64::INFINITY };
                }
            }
            if size < 1e-13 || (size < 1e-9 && size > 0.5 * before) {
                return Some(stage(2, guess));
            }
            if !size.is_finite() {
                return None;
            }
            before = size;
        }
        None
    }

    /// As [`Spectral::step`], in halves where the whole step is not found.
    fn advance(&self, state: &State, step: f64, guess: &mut [State; 3], halvings: u32) -> State {
        let before = guess.clone();
        if let Some(found) = self.step(state, step, guess) {
            return found;
        }
        assert!(halvings > 0, "{:?}: a step of {step} is not found", self.plain);
        *guess = before;
        let middle = self.advance(state, 0.5 * step, guess, halvings - 1);
        self.advance(&middle, 0.5 * step, guess, halvings - 1)
    }

    /// Contact radius and worn volume, over `a0` and `a0² d`, at times `τ`, increasing, with so many steps in a factor of ten.
    pub fn run(&self, taus: &[f64], steps: f64) -> Vec<[f64; 2]> {
        const FIRST: f64 = 1e-3;
        const HALVINGS: u32 = 12;
        let mut state: State = vec![0.0; self.places.len() - 1];
        state.push(1.0 - self.plain.stick_ratio.powi(2));
        let mut guess: [State; 3] = std::array::from_fn(|_| vec![0.0; state.len()]);
        let mut now = 0.0;
        let mut seen = vec![];
        for tau in taus {
            let span = ((tau + FIRST) / (now + FIRST)).log10();
            let count = (span * steps).ceil().max(1.0);
            let begin: f64 = now;
            for i in 1..=count as usize {
                let next = (begin + FIRST) * 10f64.powf(span * i as f64 / count) - FIRST;
                state = self.advance(&state, next - now, &mut guess, HALVINGS);
                now = next;
            }
            seen.push([self.contact_radius(&state), self.worn_volume(&state)]);
        }
        seen
    }
}

/// Points for `∫_0^ξ (ξ-η)^(-ν) b dη`.
fn inwards(map: &Map, to: &Place, nu: f64) -> Points {
    let mut points = Points { places: vec![], weights: vec![] };
    let y = 1.0 - to.left;
    // The last part holds the singularity, the others are smooth.
    let alpha = f64::from(map.alpha);
    let at_edge = to.left == 0.0;
    let upper = if at_edge { f64::from(map.edge) * (1.0 - nu) - 1.0 } else { -nu };
    let cuts: Vec<f64> =
        std::iter::once(0.0).chain((1..=CUTS).map(|i| 1.0 - 0.5f64.powi(i))).chain([1.0]).collect();
    for part in cuts.windows(2) {
        let (last, first) = (part[1] == 1.0, part[0] == 0.0);
        let (over, under) = (if last { upper } else { 0.0 }, if first { alpha } else { 0.0 });
        let rule = Rule::jacobi(NODES, over, under).unwrap();
        let total = beta(over + 1.0, under + 1.0);
        let width = y * (part[1] - part[0]);
        for ((v, w), weight) in rule.nodes.iter().zip(&rule.complements).zip(&rule.weights) {
            let within = part[0] * y + width * v;
            // Distance from the end, in y.
            let from_end = y * (1.0 - part[1]) + width * w;
            let place = map.at(within, to.left + from_end);
            let gap = if at_edge { place.complement } else { gap(map, &place, to, from_end) };
            let smooth = gap.powf(-nu) * place.slope / (w.powf(over) * v.powf(under));
            points.places.push(place);
            points.weights.push(total * weight * width * smooth);
        }
    }
    points
}

/// Points for `∫_ξ^1 (η-ξ)^(ν-1) e' dη`, by the derivative of `e` by `y`.
fn outwards(map: &Map, from: &Place, nu: f64) -> Points {
    let mut points = Points { places: vec![], weights: vec![] };
    let cuts: Vec<f64> = [0.0].into_iter().chain((0..=CUTS).rev().map(|i| 0.5f64.powi(i))).collect();
    for part in cuts.windows(2) {
        let under = if part[0] == 0.0 { nu - 1.0 } else { 0.0 };
        let rule = Rule::jacobi(NODES, 0.0, under).unwrap();
        let total = beta(1.0, under + 1.0);
        let width = from.left * (part[1] - part[0]);
        for ((v, w), weight) in rule.nodes.iter().zip(&rule.complements).zip(&rule.weights) {
            let beyond = part[0] * from.left + width * v;
            let left = from.left * (1.0 - part[1]) + width * w;
            let place = map.at(1.0 - from.left + beyond, left);
            let smooth = gap(map, from, &place, beyond).powf(nu - 1.0) / v.powf(under);
            points.places.push(place);
            points.weights.push(total * weight * width * smooth);
        }
    }
    points
}

/// `ξ` of the outer place less that of the inner one, `distance` further in `y`: where they are near, by the mean slope between them.
fn gap(map: &Map, inner: &Place, outer: &Place, distance: f64) -> f64 {
    const NEAR: f64 = 0.02;
    if distance > NEAR * inner.left {
        return if inner.value < 0.5 {
            outer.value - inner.value
        } else {
            inner.complement - outer.complement
        };
    }
    let rule = Rule::legendre(8).unwrap();
    let slope = |v: f64| map.at(1.0 - inner.left + distance * v, inner.left - distance * v).slope;
    distance * rule.mean(slope)
}

fn beta(a: f64, b: f64) -> f64 {
    libm::tgamma(a) * libm::tgamma(b) / libm::tgamma(a + b)
}
