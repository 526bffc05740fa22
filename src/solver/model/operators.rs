//! Operators of one grading on one mesh, which models share.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::derivatives::{Stencil, derivative_stencils};
use super::jacobian::{Jacobian, ScaledFactors};
use crate::error::Result;
use crate::numerics::abel::{AbelOperators, Backend, Compressed};
use crate::numerics::grid::{Clustering, Mesh};
use crate::numerics::linear::{Factors, dot};

/// The transforms and what follows from them alone.
#[derive(Debug)]
pub(super) struct Operators {
    pub abel: AbelOperators,
    pub derivative: Vec<Stencil>,
    /// For ground that moves outwards; none on smooth meshes, where none does.
    pub derivative_inwards: Vec<Stencil>,
    inverse: Inverse,
}

/// What solves for densities.
#[derive(Debug)]
enum Inverse {
    Dense {
        /// LU factors of `F` without the edge, while they are kept.
        factors: Mutex<Option<Arc<Factors>>>,
        /// Row of `F` at the edge times the inverse of the rest.
        edge_row: Vec<f64>,
    },
    Hierarchical {
        compressed: Compressed,
        /// Those of `F` without the edge, nearly, while they are kept.
        factors: Mutex<Option<Arc<ScaledFactors>>>,
    },
}

/// Key of operators: the bits of the grading and of the stretch of the mesh, number of springs, clustering, backend.
type Key = (u64, u64, usize, Clustering, Backend);

type Recent = Vec<(Key, Arc<Operators>)>;

/// Operators used last, for all models of a process; at most one that is so large that it fills the memory.
///
/// Models share them when grading, number of springs and the ratio `a∞/c` agree to the last bit: scenes that differ in load, friction,
/// wear or stiffness at one stick ratio. A model is the same bit for bit whether its operators were shared or not.
///
/// A clone is the same store.
#[derive(Debug, Clone, Default)]
pub struct OperatorStore {
    /// The ones used last first.
    recent: Arc<Mutex<Recent>>,
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
        backend: Backend,
    ) -> Result<Arc<Operators>> {
        let key = (grading.to_bits(), stretch.to_bits(), springs, clustering, backend);
        if let Some(found) = self.touch(key) {
            return Ok(found);
        }
        if springs >= MANY_SPRINGS {
            // One of that size is enough: a mesh that does not carry the contact is followed by another.
            self.recent().retain(|((_, _, springs, ..), _)| *springs < MANY_SPRINGS);
        }
        // Without the lock, so that other threads go on meanwhile; two that build the same get equal operators.
        let built = Arc::new(Operators::new(backend, grading, stretch, springs, clustering)?);
        let mut recent = self.recent();
        recent.insert(0, (key, Arc::clone(&built)));
        recent.truncate(Self::MOST);
        Ok(built)
    }

    fn recent(&self) -> MutexGuard<'_, Recent> {
        self.recent.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn touch(&self, key: Key) -> Option<Arc<Operators>> {
        let mut recent = self.recent();
        let index = recent.iter().position(|(known, _)| *known == key)?;
        recent[..=index].rotate_right(1);
        Some(Arc::clone(&recent[0].1))
    }
}

/// Springs from which on memory is given back early: the factors of `F`, a quarter of a run's memory, and operators used before.
const MANY_SPRINGS: usize = 500;

/// Most corrections of a solution with hierarchical operators.
const CORRECTIONS: usize = 40;

impl Operators {
    /// Replaces depths at the inner springs by the densities that carry them, for `Z = 1`; the depth at the edge that they carry.
    pub fn solve_profile(&self, depth: &mut Vec<f64>) -> f64 {
        match &self.inverse {
            Inverse::Dense { edge_row, .. } => {
                let at_edge = dot(edge_row, depth);
                self.dense_factors().solve(depth);
                at_edge
            }
            Inverse::Hierarchical { .. } => self.corrected(depth),
        }
    }

    /// What is carried to the edge by densities that carry depths at the inner springs, for `Z = 1`.
    pub fn depth_at_edge(&self, depth: impl Iterator<Item = f64>) -> f64 {
        match &self.inverse {
            Inverse::Dense { edge_row, .. } => {
                edge_row.iter().zip(depth).map(|(row, depth)| row * depth).sum()
            }
            Inverse::Hierarchical { .. } => self.corrected(&mut depth.collect()),
        }
    }

    /// As [`Operators::solve_profile`], by factors that are near and corrections until those are round-off.
    fn corrected(&self, depth: &mut Vec<f64>) -> f64 {
        let factors = self.hierarchical_factors();
        let inner = depth.len();
        let mut density = vec![0.0; inner];
        let (mut left, mut carried) = (depth.clone(), vec![0.0; inner + 1]);
        let mut before = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            left.push(0.0);
            factors.solve(&mut left);
            let (mut largest, mut most) = (0.0f64, 0.0f64);
            for (value, change) in density.iter_mut().zip(&left) {
                *value += change;
                (largest, most) = (largest.max(change.abs()), most.max(value.abs()));
            }
            self.abel.transforms()[0].apply(&density, &mut carried);
            left.clear();
            left.extend(depth.iter().zip(&carried).map(|(wanted, carried)| wanted - carried));
            if largest <= f64::EPSILON * most || largest > 0.5 * before {
                break;
            }
            before = largest;
        }
        *depth = density;
        carried[inner]
    }

    /// The compressed transforms, where the operators are hierarchical.
    pub fn compressed(&self) -> Option<&Compressed> {
        match &self.inverse {
            Inverse::Dense { .. } => None,
            Inverse::Hierarchical { compressed, .. } => Some(compressed),
        }
    }

    fn dense_factors(&self) -> Arc<Factors> {
        let Inverse::Dense { factors, .. } = &self.inverse else { unreachable!("asked of dense operators") };
        kept(factors, || dense_factors(&self.abel))
    }

    fn hierarchical_factors(&self) -> Arc<ScaledFactors> {
        let Inverse::Hierarchical { compressed, factors } = &self.inverse else {
            unreachable!("asked of hierarchical operators")
        };
        kept(factors, || {
            let n = self.abel.len();
            let mut row_factor = vec![1.0; n];
            row_factor[n - 1] = 0.0;
            let column_factor = vec![1.0; n - 1];
            let jacobian = Jacobian {
                abel: &self.abel,
                stencils: &self.derivative,
                row_factor: &row_factor,
                column_factor: &column_factor,
                along: 0.0,
                pressure_factor: 0.0,
                corner: 1.0,
            };
            jacobian.factors(compressed, None)
        })
    }

    /// Frees the factors where they are large; they are made again when they are needed.
    pub fn release_factors(&self) {
        if self.abel.len() < MANY_SPRINGS {
            return;
        }
        match &self.inverse {
            Inverse::Dense { factors, .. } => release(factors),
            Inverse::Hierarchical { factors, .. } => release(factors),
        }
    }

    fn new(
        backend: Backend,
        grading: f64,
        stretch: f64,
        springs: usize,
        clustering: Clustering,
    ) -> Result<Self> {
        let abel = AbelOperators::with(backend, grading, Mesh::new(springs, stretch, clustering))?;
        let inverse = match backend {
            Backend::Dense => {
                let inner = springs - 1;
                let factors = dense_factors(&abel);
                let mut edge_row: Vec<f64> = (0..inner).map(|j| abel.profile()[(inner, j)]).collect();
                factors.solve_transposed(&mut edge_row);
                Inverse::Dense { factors: Mutex::new(Some(Arc::new(factors))), edge_row }
            }
            Backend::Hierarchical => {
                Inverse::Hierarchical { compressed: Compressed::new(&abel), factors: Mutex::default() }
            }
        };
        let mesh = abel.mesh();
        let derivative_inwards = match clustering {
            clustering if clustering.is_even() => vec![],
            _ => derivative_stencils(mesh, 1, 1.0),
        };
        Ok(Self { derivative: derivative_stencils(mesh, 0, 1.0), derivative_inwards, abel, inverse })
    }
}

/// What is kept, made anew where it is not.
fn kept<T>(place: &Mutex<Option<Arc<T>>>, make: impl FnOnce() -> T) -> Arc<T> {
    let mut kept = place.lock().unwrap_or_else(PoisonError::into_inner);
    Arc::clone(kept.get_or_insert_with(|| Arc::new(make())))
}

fn release<T>(place: &Mutex<Option<Arc<T>>>) {
    *place.lock().unwrap_or_else(PoisonError::into_inner) = None;
}

/// LU factors of `F` without the edge.
fn dense_factors(abel: &AbelOperators) -> Factors {
    let inner = abel.len() - 1;
    Factors::new(abel.profile().submatrix(0, 0, inner, inner).to_owned())
}
