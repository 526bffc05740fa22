//! Who is better than whom.

/// An error below another by less than this part of it is no smaller: the last digits are worth no cost.
const SAME_ERROR: f64 = 1e-2;

/// The Pareto front: candidates for which no other is at least as cheap and as accurate, and better in one of the two. An error that is
/// smaller by less than a hundredth is the same.
///
/// # Arguments
/// * `points` -- cost and error of each candidate; one that is not finite has none
///
/// Returns places in `points`, by rising cost and so by falling error; of equals the first.
///
/// ```
/// use fretwear::study::tradeoff::pareto_front;
/// let points = [(1.0, 1e-2), (2.0, 1e-3), (3.0, 5e-3), (4.0, 1e-4), (2.0, 1e-3), (0.5, f64::NAN)];
/// assert_eq!(pareto_front(&points), [0, 1, 3]);
/// ```
pub fn pareto_front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|i| points[*i].0.is_finite() && points[*i].1.is_finite()).collect();
    // A stable sort: of equals the first stays first.
    order.sort_by(|a, b| points[*a].0.total_cmp(&points[*b].0).then(points[*a].1.total_cmp(&points[*b].1)));
    let mut least = f64::INFINITY;
    order.retain(|i| {
        let better = points[*i].1 < least * (1.0 - SAME_ERROR) || least.is_infinite();
        if better {
            least = points[*i].1;
        }
        better
    });
    order
}

/// What the cheapest of some candidates with at most this error costs; none if there is no such candidate.
///
/// ```
/// use fretwear::study::tradeoff::cheapest;
/// let points = [(1.0, 1e-2), (2.0, 1e-3), (4.0, 1e-4)];
/// assert_eq!([1e-1, 2e-3, 1e-4, 1e-5].map(|error| cheapest(&points, error)), [Some(1.0), Some(2.0), Some(4.0), None]);
/// ```
pub fn cheapest(points: &[(f64, f64)], error: f64) -> Option<f64> {
    let costs = points.iter().filter(|it| it.1 <= error).map(|it| it.0);
    costs.filter(|cost| cost.is_finite()).min_by(f64::total_cmp)
}
