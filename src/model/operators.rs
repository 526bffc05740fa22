//! Operators of one grading on one mesh, which models of the same can share.

use std::sync::{Arc, Mutex, PoisonError};

use super::derivatives::{Stencil, derivative_stencils};
use crate::abel::AbelOperators;
use crate::error::Result;
use crate::grid::{Clustering, Mesh};
use crate::linear::Factors;

/// The transforms and what follows from them alone.
#[derive(Debug)]
pub(super) struct Operators {
    pub abel: AbelOperators,
    /// LU factors of `F` without the edge, while they are kept.
    factors: Mutex<Option<Arc<Factors>>>,
    /// Row of `F` at the edge times the inverse of the rest.
    pub edge_row: Vec<f64>,
    pub derivative: Vec<Stencil>,
}

/// What tells operators apart: the bits of the grading and of the stretch of the mesh, number of springs and clustering.
type Key = (u64, u64, usize, Clustering);

type Kept = Vec<(Key, Arc<Operators>)>;

/// Operators used last, for all the models of a process; one at most of those so large that they fill the memory.
///
/// Models share them when grading, number of springs and the ratio `a∞/c` agree to the last bit: scenes that differ in load, friction,
/// wear or stiffness at one stick ratio. A model is the same bit for bit whether its operators were shared or not.
///
/// A clone is the same store.
#[derive(Debug, Clone, Default)]
pub struct OperatorStore {
    kept: Arc<Mutex<Kept>>,
}

impl OperatorStore {
    /// Most operators kept; those used longest ago go first.
    const MOST: usize = 16;

    pub(super) fn get(
        &self,
        grading: f64,
        stretch: f64,
        springs: usize,
        clustering: Clustering,
    ) -> Result<Arc<Operators>> {
        let key = (grading.to_bits(), stretch.to_bits(), springs, clustering);
        if let Some(found) = self.touch(key) {
            return Ok(found);
        }
        if springs >= MANY_SPRINGS {
            // One of that size is enough: on a mesh that did not do, another follows.
            let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
            kept.retain(|((_, _, springs, _), _)| *springs < MANY_SPRINGS);
        }
        // Without the lock, so that others go on meanwhile; two that build the same build it equal.
        let built = Arc::new(Operators::new(grading, stretch, springs, clustering)?);
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.insert(0, (key, Arc::clone(&built)));
        kept.truncate(Self::MOST);
        Ok(built)
    }

    fn touch(&self, key: Key) -> Option<Arc<Operators>> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let place = kept.iter().position(|(known, _)| *known == key)?;
        kept[..=place].rotate_right(1);
        Some(Arc::clone(&kept[0].1))
    }
}

/// Springs from which on what is not needed any more is not kept: the factors of `F`, a quarter of a run's memory, and operators used before.
const MANY_SPRINGS: usize = 500;

impl Operators {
    /// LU factors of `F` without the edge.
    pub fn factors(&self) -> Arc<Factors> {
        let mut kept = self.factors.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(kept.get_or_insert_with(|| Arc::new(factors(&self.abel))))
    }

    /// Gives the factors back where they are large; whoever asks for them again waits for them to be made anew.
    pub fn release_factors(&self) {
        if self.abel.len() >= MANY_SPRINGS {
            *self.factors.lock().unwrap_or_else(PoisonError::into_inner) = None;
        }
    }

    fn new(grading: f64, stretch: f64, springs: usize, clustering: Clustering) -> Result<Self> {
        let abel = AbelOperators::new(grading, Mesh::new(springs, stretch, clustering))?;
        let inner = springs - 1;
        let factors = factors(&abel);
        let mut edge_row: Vec<f64> = (0..inner).map(|j| abel.profile()[(inner, j)]).collect();
        factors.solve_transposed(&mut edge_row);
        let factors = Mutex::new(Some(Arc::new(factors)));
        Ok(Self { derivative: derivative_stencils(abel.mesh()), abel, factors, edge_row })
    }
}

/// LU factors of `F` without the edge.
fn factors(abel: &AbelOperators) -> Factors {
    let inner = abel.len() - 1;
    Factors::new(abel.profile().submatrix(0, 0, inner, inner).to_owned())
}
