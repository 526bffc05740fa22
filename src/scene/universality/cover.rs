//! A covering design: few combinations in which each pair of levels meets.

use std::collections::HashSet;

/// Combinations of one level of each factor in which every two levels of different factors meet at least once, if they do in any
/// combination that is allowed.
///
/// Greedy: of all combinations the one that brings most new pairs, of equals the one whose levels were used least so far, of equals the
/// first. The product of the two largest factors is a lower bound; for the sizes of a study the design stays near it.
///
/// # Arguments
/// * `levels` -- number of levels of each factor
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
    let candidates: Vec<Vec<usize>> =
        combinations(levels).into_iter().filter(|levels| allowed(levels)).collect();
    if levels.len() < 2 {
        return candidates;
    }
    let mut open: HashSet<Pair> = candidates.iter().flat_map(|it| pairs(it)).collect();
    let mut used: Vec<Vec<usize>> = levels.iter().map(|count| vec![0; *count]).collect();
    let mut chosen: Vec<Vec<usize>> = vec![];
    while !open.is_empty() {
        let worth = |it: &Vec<usize>| {
            let new = pairs(it).filter(|pair| open.contains(pair)).count();
            let wear: usize = it.iter().zip(&used).map(|(level, used)| used[*level]).sum();
            (new, std::cmp::Reverse(wear))
        };
        // Of equals, max_by_key gives the last.
        let best = candidates.iter().rev().max_by_key(|it| worth(it)).expect("an open pair has a candidate");
        pairs(best).for_each(|pair| {
            open.remove(&pair);
        });
        best.iter().zip(&mut used).for_each(|(level, used)| used[*level] += 1);
        chosen.push(best.clone());
    }
    chosen.sort();
    chosen
}

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

/// Factor and level of one, factor and level of the other.
type Pair = [usize; 4];

fn pairs(levels: &[usize]) -> impl Iterator<Item = Pair> {
    (0..levels.len()).flat_map(move |a| (a + 1..levels.len()).map(move |b| [a, levels[a], b, levels[b]]))
}
