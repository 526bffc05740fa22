//! Compressions by which springs slip where the indenter moves up and down.

/// Part of what a spring pulls that each of its neighbours bears for it.
const BORNE: f64 = 0.5;

/// Compression by which a spring slips at least, over that of the next one outwards.
const LEAST: f64 = 0.5;

/// The compressions by which springs slip, which are their own where all of them press.
///
/// Where what is left of the pressure next to the edge of stick falls off within a cell, compressions swing about what they are, and some springs pull. A spring that pulls
/// never touches while the indenter moves up and down, and would not slip: no wear would bring it back, and slip would end farther out from spring to spring. So its neighbours
/// bear for it what it pulls, half each, which takes the swing out of theirs, and every spring slips by half the compression of the next one outwards at least.
#[derive(Debug)]
pub(super) struct Slipping {
    compression: Vec<f64>,
    /// By which springs each follows, with the derivatives by their compressions; none where each follows its own.
    follows: Vec<Vec<(usize, f64)>>,
}

impl Slipping {
    /// # Arguments
    /// * `compression` -- at the largest indentation, m, shape `(springs - 1,)`
    pub fn new(compression: &[f64]) -> Self {
        let presses =
            |i: usize| compression[i] >= LEAST * compression.get(i + 1).copied().unwrap_or(0.0).max(0.0);
        if (0..compression.len()).all(presses) {
            return Self { compression: compression.to_vec(), follows: vec![] };
        }
        let mut found = Self { compression: vec![], follows: vec![] };
        for i in 0..compression.len() {
            let (value, follows) = relieved(compression, i);
            found.compression.push(value);
            found.follows.push(follows);
        }
        for i in (1..compression.len()).rev() {
            let least = LEAST * found.compression[i];
            if found.compression[i - 1] < least {
                found.compression[i - 1] = least;
                found.follows[i - 1] =
                    found.follows[i].iter().map(|(of, slope)| (*of, LEAST * slope)).collect();
            }
        }
        found
    }

    /// The compressions, m, shape `(springs - 1,)`.
    pub fn compressions(&self) -> &[f64] {
        &self.compression
    }

    /// The springs by which each follows, with the derivatives by their compressions; none where each follows its own.
    pub fn into_follows(self) -> Vec<Vec<(usize, f64)>> {
        self.follows
    }
}

/// Compression of a spring less what its neighbours pull, at least zero, and its derivatives.
fn relieved(compression: &[f64], i: usize) -> (f64, Vec<(usize, f64)>) {
    let neighbours = [i.checked_sub(1), Some(i + 1)].into_iter().flatten();
    let pulling = neighbours.filter(|j| compression.get(*j).is_some_and(|q| *q < 0.0));
    let follows: Vec<(usize, f64)> = std::iter::once((i, 1.0)).chain(pulling.map(|j| (j, BORNE))).collect();
    let value: f64 = follows.iter().map(|(j, part)| part * compression[*j]).sum();
    if compression[i] < 0.0 || value <= 0.0 { (0.0, vec![]) } else { (value, follows) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn springs_that_press_slip_by_their_own_compressions() {
        let pressed = [3.0, 2.0, 2.5, 1.0, 0.0];
        let slipping = Slipping::new(&pressed);
        assert_eq!(slipping.compressions(), pressed);
        assert!(slipping.into_follows().is_empty());
    }

    #[test]
    fn swings_of_alternate_sign_cancel() {
        let swinging = [-1.0, 3.0, -1.0, 3.0, 1.0];
        assert_eq!(Slipping::new(&swinging).compressions(), [1.0, 2.0, 1.25, 2.5, 1.0]);
    }

    /// By differences, where neighbours bear for a spring and where it follows one that does.
    #[test]
    fn derivatives_are_those_of_the_compressions() {
        let swinging = [-1.0, 0.2, 0.9, -0.5, 2.0, 0.1];
        let at = Slipping::new(&swinging);
        let (before, follows) = (at.compressions().to_vec(), at.into_follows());
        for j in 0..swinging.len() {
            let mut moved = swinging;
            moved[j] += 1e-6;
            let after = Slipping::new(&moved);
            for i in 0..swinging.len() {
                let slope = (after.compressions()[i] - before[i]) / 1e-6;
                let said: f64 = follows[i].iter().filter(|(of, _)| *of == j).map(|(_, slope)| slope).sum();
                assert!((slope - said).abs() < 1e-8, "spring {i} by {j}: {slope} against {said}");
            }
        }
    }
}
