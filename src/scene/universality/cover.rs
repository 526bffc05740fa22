//! A covering design: few combinations in which each pair of levels meets.

use std::cmp::Reverse;
use std::collections::HashSet;

/// Most designs that are compared, and most candidates looked at for all their first picks together.
const MOST_DESIGNS: usize = 64;
const MOST_CANDIDATES: usize = 200_000;

/// Combinations of one level of each factor in which every two levels of different factors meet at least once, if they do in any
/// combination that is allowed.
///
/// Greedy: of all combinations the one that brings most new pairs is next. Which one of equals is taken decides how many it becomes, so
/// several orders of equals are tried, always the same, and the shortest design is given. The product of the two largest factors is a
/// lower bound; for the sizes of a study the design stays near it.
///
/// # Arguments
/// * `levels` -- number of levels of each factor, at least 1
/// * `allowed` -- whether a combination may be used; one place for each factor
///
/// # Examples
/// ```
/// use fretwear::scene::covering_design;
///
/// // Three factors of two levels: four combinations instead of eight.
/// assert_eq!(covering_design(&[2, 2, 2], |_| true), [[0, 0, 0], [0, 1, 1], [1, 0, 1], [1, 1, 0]]);
/// ```
pub fn covering_design(levels: &[usize], allowed: impl Fn(&[usize]) -> bool) -> Vec<Vec<usize>> {
    let candidates: Vec<Vec<usize>> = combinations(levels).into_iter().filter(|it| allowed(it)).collect();
    // A factor of one level meets all that occurs.
    let varied: Vec<usize> = (0..levels.len()).filter(|&factor| levels[factor] > 1).collect();
    if varied.len() < 2 {
        return candidates;
    }
    let designs = (MOST_CANDIDATES / candidates.len().max(1)).clamp(1, MOST_DESIGNS);
    let designs = (0..designs as u64).map(|order| greedy(&candidates, &varied, order));
    let mut shortest = designs.min_by_key(Vec::len).expect("one order at least is tried");
    shortest.sort();
    shortest
}

/// One design; `order` decides between equals, 0 for the first of them.
fn greedy(candidates: &[Vec<usize>], varied: &[usize], order: u64) -> Vec<Vec<usize>> {
    let pairs = |it: &[usize]| -> Vec<Pair> {
        let both = varied.iter().enumerate().flat_map(|(i, a)| varied[i + 1..].iter().map(move |b| (*a, *b)));
        both.map(|(a, b)| [a, it[a], b, it[b]]).collect()
    };
    let mut open: HashSet<Pair> = candidates.iter().flat_map(|it| pairs(it)).collect();
    let mut chosen: Vec<Vec<usize>> = vec![];
    while !open.is_empty() {
        let worth = |(place, it): &(usize, &Vec<usize>)| {
            let new = pairs(it).iter().filter(|pair| open.contains(*pair)).count();
            (new, Reverse(shuffled(*place as u64, order)), Reverse(*place))
        };
        let best = candidates.iter().enumerate().max_by_key(worth);
        let (_, best) = best.expect("an open pair has a candidate");
        for pair in pairs(best) {
            open.remove(&pair);
        }
        chosen.push(best.clone());
    }
    chosen
}

/// A place in an order of its own for each `order`; all equal for 0.
fn shuffled(place: u64, order: u64) -> u64 {
    // SplitMix64, Steele, Lea, Flood, OOPSLA 2014.
    let mut z = (place + 1).wrapping_mul(order).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Factor and level of one, factor and level of the other.
type Pair = [usize; 4];

/// All combinations, the last factor running fastest.
pub(super) fn combinations(levels: &[usize]) -> Vec<Vec<usize>> {
    levels.iter().fold(vec![vec![]], |shorter, count| {
        let longer = |start: &Vec<usize>| {
            let start = start.clone();
            (0..*count).map(move |level| start.iter().copied().chain([level]).collect())
        };
        shorter.iter().flat_map(longer).collect()
    })
}
