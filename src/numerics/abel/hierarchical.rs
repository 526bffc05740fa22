//! A transform between the springs as a hierarchical matrix: what is near weight by weight, what is far by interpolation of the kernel.
//!
//! In the coordinate `y` of the [`Mesh`], in which nodes are even, the kernels of Eqs. (20) and (21) are analytic away from the diagonal, at the
//! graded ends of the annulus too. Cells are gathered in leaves, leaves in pairs, and so on; a cluster of cells and a cluster of nodes that have
//! another one between them see each other through Chebyshev polynomials of `y` on either side (an H²-matrix: Hackbusch, Hierarchical Matrices,
//! ch. 8; with even clusters the one-dimensional fast multipole method). All clusters of a level have the same shape in `y`, so that what
//! carries moments from level to level, and the polynomials in a leaf, are the same small matrices everywhere.
//!
//! The local polynomials of the data are integrated exactly on both sides: the weights are those of the dense matrix but for the
//! interpolation of the kernel, whose error falls with 5.8 to the power of [`TERMS`]. Those of Eq. (21), which takes a derivative, act on the
//! differences of neighbouring compressions: next to the edge of stick, where springs are dense and compressions nearly equal, the sum of large
//! weights of either sign would be round-off.

use std::ops::Range;

use faer::{Mat, MatMut, MatRef};
use rayon::prelude::*;

use super::Transform;
use super::weights::{Assembly, Cell, Direction, Kernel};
use crate::numerics::grid::{Clustering, MeshPoint};
use crate::numerics::linear::{add_product, in_parallel, product};

/// Cells of a leaf.
pub(super) const LEAF: usize = 32;

/// Chebyshev polynomials of a cluster.
pub(super) const TERMS: usize = 18;

/// `Λ` times the part of the mesh that a cluster spans, at most: where `ξ` grows by more along it, the kernel is less smooth than between its
/// neighbours.
const LARGEST_GROWTH: f64 = 4.0;

/// Steepest `g'` of a mesh.
const STEEPEST: f64 = 2.2;

/// Clusters of a level of which no two are far from each other.
const FEWEST_CLUSTERS: usize = 3;

/// Part of the mesh, in cells.
#[derive(Debug, Clone, Copy)]
struct Span {
    start: usize,
    length: usize,
}

impl Span {
    /// A cluster of `width` cells, of which the last one ends with the mesh.
    fn new(cluster: usize, width: usize, cells: usize) -> Self {
        let start = cluster * width;
        Self { start, length: width.min(cells.saturating_sub(start)) }
    }

    /// Chebyshev points.
    fn points(self) -> impl Iterator<Item = f64> {
        chebyshev_points().map(move |point| self.start as f64 + point * self.length as f64)
    }

    /// Lagrange polynomials on these points at `y`.
    fn polynomials_at(self, y: f64) -> [f64; TERMS] {
        polynomial_values((y - self.start as f64) / self.length as f64)
    }

    /// The same at some places, a row each.
    fn polynomials(self, places: impl Iterator<Item = f64>) -> Mat<f64> {
        let rows: Vec<[f64; TERMS]> = places.map(|y| self.polynomials_at(y)).collect();
        Mat::from_fn(rows.len(), TERMS, |i, j| rows[i][j])
    }
}

/// A transform in `O(n)` numbers, applied in as many operations.
#[derive(Debug, Clone)]
pub struct Hierarchical {
    direction: Direction,
    nodes: usize,
    /// What nodes of a leaf receive from the cells of that leaf and its neighbour.
    near: Vec<Near>,
    /// Integrals of the Chebyshev polynomials of a leaf times the local polynomials of its cells.
    moments: Vec<Moments>,
    /// Index of those of each leaf.
    moments_of: Vec<usize>,
    /// Chebyshev polynomials of a leaf at its nodes, shape `(LEAF, TERMS)`, and of the last leaf, which may be shorter.
    at_nodes: [Mat<f64>; 2],
    /// Polynomials of a cluster at the points of its halves, shape `(TERMS, TERMS)` each: row of the point, column of the polynomial.
    at_halves: [Mat<f64>; 2],
    /// From the leaves up.
    levels: Vec<Level>,
}

/// A block of weights, column by column without the zeros above and below.
#[derive(Debug, Clone)]
struct Near {
    columns: Vec<NearColumn>,
    weights: Vec<f64>,
}

#[derive(Debug, Clone)]
struct NearColumn {
    column: u32,
    first_row: u32,
    first_weight: u32,
}

#[derive(Debug, Clone, PartialEq)]
struct Moments {
    /// Column of the first node, over that of the leaf.
    shift: isize,
    /// Shape `(TERMS, nodes)`.
    matrix: Mat<f64>,
}

/// Clusters of one size that see each other.
#[derive(Debug, Clone)]
struct Level {
    clusters: usize,
    /// [`Hierarchical::at_halves`] of the last cluster, which ends with the mesh; the second half may not be there.
    at_last_halves: [Mat<f64>; 2],
    /// For each cluster the sources that it sees: where in `couplings` they begin, and the first of them.
    seen: Vec<Seen>,
    /// Kernel at the points, shape `(TERMS, TERMS)` each, row of the target.
    couplings: Vec<f64>,
}

#[derive(Debug, Clone, Default)]
struct Seen {
    sources: Range<usize>,
    first: usize,
}

impl Hierarchical {
    pub(super) fn new(assembly: &Assembly<'_>, direction: Direction) -> Self {
        let mesh = assembly.mesh;
        let nodes = mesh.cells();
        let leaves = nodes.div_ceil(LEAF);
        let near = (0..leaves).into_par_iter().map(|leaf| Near::new(assembly, direction, leaf)).collect();
        let mut moments: Vec<Moments> = Vec::new();
        // Stencils are shifted and degrees reduced next to the ends only; elsewhere polynomials of y look the same from every leaf.
        let mut inner = None;
        let moments_of = (0..leaves)
            .map(|leaf| {
                let is_inner = mesh.clustering() == Clustering::Smooth && leaf > 0 && leaf + 2 < leaves;
                if let Some(known) = inner.filter(|_| is_inner) {
                    return known;
                }
                moments.push(Moments::new(assembly, direction, leaf));
                let index = moments.len() - 1;
                inner = inner.or(is_inner.then_some(index));
                index
            })
            .collect();
        let all = Span { start: 0, length: LEAF };
        let last = Span::new(leaves - 1, LEAF, nodes);
        let at_nodes =
            [all, last].map(|span| span.polynomials((1..=span.length).map(|i| (span.start + i) as f64)));
        let pair = Span { start: 0, length: 2 * LEAF };
        let at_halves = [0, 1].map(|half| pair.polynomials(Span::new(half, LEAF, 2 * LEAF).points()));
        let growth = mesh.stretch() * STEEPEST / nodes as f64;
        let coarsest = |width: usize| growth * (2 * width) as f64 > LARGEST_GROWTH;
        let (mut levels, mut clusters, mut width) = (Vec::new(), leaves, LEAF);
        loop {
            let last = clusters <= FEWEST_CLUSTERS || coarsest(width);
            levels.push(Level::new(assembly, direction, clusters, width, last));
            if last {
                break;
            }
            (clusters, width) = (clusters.div_ceil(2), 2 * width);
        }
        Self { direction, nodes, near, moments, moments_of, at_nodes, at_halves, levels }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let near: usize = self.near.iter().map(|near| 8 * near.weights.len() + 12 * near.columns.len()).sum();
        let far: usize = self.levels.iter().map(|level| 8 * level.couplings.len()).sum();
        let moments: usize = self.moments.iter().map(|it| 8 * it.matrix.nrows() * it.matrix.ncols()).sum();
        near + far + moments
    }

    /// The weight at a row and a column, both from zero, that are less than a leaf apart; zero on the side where there is none.
    pub(super) fn near_weight(&self, row: usize, column: usize) -> f64 {
        self.near[row / LEAF].weight(row % LEAF, column).unwrap_or(0.0)
    }

    /// Adds `factor` times the weights of some rows and columns, both from zero, that have one of their own; `to` has them at its origin.
    pub(super) fn add_near(&self, rows: Range<usize>, columns: Range<usize>, factor: f64, to: &mut Mat<f64>) {
        for leaf in rows.start / LEAF..rows.end.div_ceil(LEAF) {
            let near = &self.near[leaf];
            let from = near.columns.partition_point(|it| (it.column as usize) < columns.start);
            for (index, column) in near.columns.iter().enumerate().skip(from) {
                let j = column.column as usize;
                if j >= columns.end {
                    break;
                }
                let weights = near.column(index);
                let first = leaf * LEAF + column.first_row as usize;
                let begin = rows.start.max(first);
                let end = rows.end.min(first + weights.len());
                if begin < end {
                    let to =
                        &mut to.col_as_slice_mut(j - columns.start)[begin - rows.start..end - rows.start];
                    for (to, weight) in to.iter_mut().zip(&weights[begin - first..]) {
                        *to += factor * weight;
                    }
                }
            }
        }
    }

    /// Moments of the leaves, shape `(TERMS, leaves)`, column by column.
    fn leaf_moments(&self, x: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; TERMS * self.near.len()];
        in_parallel(&mut all, TERMS, |first, part| {
            let indices = &self.moments_of[first..first + part.len() / TERMS];
            let mut leaf = first;
            let mut rest = part;
            for same in indices.chunk_by(|a, b| a == b) {
                let moments = &self.moments[same[0]];
                let value = |i: usize, j: usize| {
                    let place = ((leaf + j) * LEAF + i) as isize + moments.shift;
                    usize::try_from(place).ok().and_then(|place| x.get(place)).copied().unwrap_or(0.0)
                };
                let data = Mat::from_fn(moments.matrix.ncols(), same.len(), value);
                let (to, others) = rest.split_at_mut(TERMS * same.len());
                let to = MatMut::from_column_major_slice_mut(to, TERMS, same.len());
                product(to, moments.matrix.as_ref(), data.as_ref(), 1.0);
                (leaf, rest) = (leaf + same.len(), others);
            }
        });
        all
    }

    /// Moments of the clusters of a level from those of their halves.
    fn gather(&self, below: &[f64], level: &Level) -> Vec<f64> {
        let mut gathered = vec![0.0; TERMS * level.clusters];
        in_parallel(&mut gathered, TERMS, |first, part| {
            let count = part.len() / TERMS;
            let others = count - usize::from(first + count == level.clusters);
            for (half, matrix) in self.at_halves.iter().enumerate() {
                gather(matrix, &below[TERMS * (2 * first + half).min(below.len() / TERMS)..], part, others);
            }
            if others < count {
                for (half, matrix) in level.at_last_halves.iter().enumerate().filter(|(_, it)| it.nrows() > 0)
                {
                    gather(
                        matrix,
                        &below[TERMS * (2 * (first + others) + half)..],
                        &mut part[TERMS * others..],
                        1,
                    );
                }
            }
        });
        gathered
    }

    /// What the clusters of a level have from those they are halves of.
    fn hand_down(&self, above: &[f64], level: &Level, clusters: usize) -> Vec<f64> {
        let mut field = vec![0.0; TERMS * clusters];
        in_parallel(&mut field, TERMS, |first, part| {
            // Tasks begin with a first half.
            let count = part.len() / TERMS;
            let parents = count.div_ceil(2);
            let others = parents - usize::from(first / 2 + parents == level.clusters);
            let above = &above[TERMS * (first / 2)..];
            for (half, matrix) in self.at_halves.iter().enumerate() {
                hand_down(matrix, above, &mut part[TERMS * half.min(count)..], others);
            }
            if others < parents {
                for (half, matrix) in level.at_last_halves.iter().enumerate().filter(|(_, it)| it.nrows() > 0)
                {
                    hand_down(matrix, &above[TERMS * others..], &mut part[TERMS * (2 * others + half)..], 1);
                }
            }
        });
        field
    }

    /// Adds what the nodes of some leaves from `first` on receive.
    fn at_leaves(&self, first: usize, field: &[f64], x: &[f64], y: &mut [f64]) {
        let leaves = y.len().div_ceil(LEAF);
        let others = leaves - usize::from(first + leaves == self.near.len());
        let field = MatRef::from_column_major_slice(&field[TERMS * first..][..TERMS * leaves], TERMS, leaves);
        let (head, tail) = y.split_at_mut(others * LEAF);
        let to = MatMut::from_column_major_slice_mut(head, LEAF, others);
        product(to, self.at_nodes[0].as_ref(), field.subcols(0, others), 1.0);
        if others < leaves {
            let count = tail.len();
            let to = MatMut::from_column_major_slice_mut(tail, count, 1);
            product(to, self.at_nodes[1].as_ref(), field.subcols(others, 1), 1.0);
        }
        for (near, y) in self.near[first..].iter().zip(y.chunks_mut(LEAF)) {
            near.add(x, y);
        }
    }
}

impl Transform for Hierarchical {
    fn apply(&self, x: &[f64], y: &mut [f64]) {
        assert!(x.len() <= self.nodes && y.len() == self.nodes, "{} and {} values", x.len(), y.len());
        let x = &*self.direction.acts_on(x);
        let mut moments = vec![self.leaf_moments(x)];
        for level in &self.levels[1..] {
            moments.push(self.gather(&moments[moments.len() - 1], level));
        }
        let mut field: Option<(Vec<f64>, &Level)> = None;
        for (level, moments) in self.levels.iter().zip(&moments).rev() {
            let mut seen = match field {
                None => vec![0.0; TERMS * level.clusters],
                Some((field, above)) => self.hand_down(&field, above, level.clusters),
            };
            level.add(moments, &mut seen);
            field = Some((seen, level));
        }
        let (field, _) = field.expect("there is a level");
        in_parallel(y, LEAF, |first, part| self.at_leaves(first, &field, x, part));
    }
}

/// Adds the moments of every second cluster `from` on to those of `count` clusters that they are halves of.
fn gather(at_halves: &Mat<f64>, from: &[f64], to: &mut [f64], count: usize) {
    if count == 0 {
        return;
    }
    let from = MatRef::from_column_major_slice_with_stride(from, TERMS, count, 2 * TERMS);
    let to = MatMut::from_column_major_slice_mut(&mut to[..TERMS * count], TERMS, count);
    add_product(to, at_halves.transpose(), from, 1.0);
}

/// Sets every second cluster `to` on to what it has from that of `count` clusters which it is a half of.
fn hand_down(at_halves: &Mat<f64>, from: &[f64], to: &mut [f64], count: usize) {
    if count == 0 {
        return;
    }
    let from = MatRef::from_column_major_slice(&from[..TERMS * count], TERMS, count);
    let to = MatMut::from_column_major_slice_with_stride_mut(to, TERMS, count, 2 * TERMS);
    product(to, at_halves.as_ref(), from, 1.0);
}

impl Near {
    fn new(assembly: &Assembly<'_>, direction: Direction, leaf: usize) -> Self {
        let mesh = assembly.mesh;
        let last = mesh.cells();
        let nodes = leaf * LEAF + 1..((leaf + 1) * LEAF).min(last) + 1;
        let cells = match direction {
            Direction::Outwards => leaf.saturating_sub(1) * LEAF..nodes.end - 1,
            Direction::Inwards => nodes.start..((leaf + 2) * LEAF).min(last),
        };
        let (first, end) = cells.clone().fold((last, 0), |(first, end), cell| {
            let stencil = assembly.stencil(cell);
            (first.min(stencil.start), end.max(stencil.end))
        });
        if first >= end {
            return Self { columns: Vec::new(), weights: Vec::new() };
        }
        let rows = nodes.len();
        let mut block = Mat::<f64>::zeros(rows, end - first);
        for index in cells {
            Cell::new(assembly, index, direction).add(nodes.clone(), first, &mut block);
        }
        let mut near = Self { columns: Vec::with_capacity(end - first), weights: Vec::new() };
        for (j, column) in block.col_iter().enumerate() {
            let filled = |i: &usize| column[*i] != 0.0;
            let Some(from) = (0..rows).find(filled) else { continue };
            let to = (0..rows).rfind(filled).unwrap_or(from);
            near.columns.push(NearColumn {
                column: (first + j - 1) as u32,
                first_row: from as u32,
                first_weight: near.weights.len() as u32,
            });
            near.weights.extend((from..=to).map(|i| column[i]));
        }
        near.weights.shrink_to_fit();
        near
    }

    fn column(&self, index: usize) -> &[f64] {
        let begin = self.columns[index].first_weight as usize;
        let end = self.columns.get(index + 1).map_or(self.weights.len(), |next| next.first_weight as usize);
        &self.weights[begin..end]
    }

    fn add(&self, x: &[f64], y: &mut [f64]) {
        for (index, column) in self.columns.iter().enumerate() {
            let Some(&factor) = x.get(column.column as usize) else { continue };
            let weights = self.column(index);
            let rows = column.first_row as usize..column.first_row as usize + weights.len();
            for (value, weight) in y[rows].iter_mut().zip(weights) {
                *value += factor * weight;
            }
        }
    }

    fn weight(&self, row: usize, column: usize) -> Option<f64> {
        let index = self.columns.binary_search_by_key(&(column as u32), |it| it.column).ok()?;
        let first = self.columns[index].first_row as usize;
        self.column(index).get(row.checked_sub(first)?).copied()
    }
}

impl Moments {
    fn new(assembly: &Assembly<'_>, direction: Direction, leaf: usize) -> Self {
        let mesh = assembly.mesh;
        let last = mesh.cells();
        let cells = (leaf * LEAF).max(direction.first_cell())..((leaf + 1) * LEAF).min(last);
        let start = cells.clone().map(|cell| assembly.stencil(cell).start).min().unwrap_or(1);
        let end = cells.clone().map(|cell| assembly.stencil(cell).end).max().unwrap_or(1);
        let span = Span::new(leaf, LEAF, last);
        let mut matrix = Mat::zeros(TERMS, end - start);
        for cell in cells {
            let stencil = assembly.stencil(cell);
            let rule = assembly.plain_rule();
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let y = cell as f64 + node;
                let point = mesh.at(y);
                let local = match direction {
                    Direction::Outwards => mesh.lagrange(&stencil, y, &point),
                    Direction::Inwards => mesh.lagrange_derivative(&stencil, y, &point),
                };
                let polynomials = span.polynomials_at(y);
                for (column, value) in stencil.clone().zip(direction.weights(local, stencil.len())) {
                    for (row, polynomial) in polynomials.iter().enumerate() {
                        matrix[(row, column - start)] += weight * value * polynomial;
                    }
                }
            }
        }
        Self { shift: start as isize - 1 - (leaf * LEAF) as isize, matrix }
    }
}

impl Level {
    /// The clusters of `width` cells; on the last level they see everything that is far, else what those they are halves of do not see.
    fn new(assembly: &Assembly<'_>, direction: Direction, clusters: usize, width: usize, last: bool) -> Self {
        let sources = |target: usize| match direction {
            Direction::Outwards => {
                let first = if last { 0 } else { (target / 2 * 2).saturating_sub(2) };
                first..target.saturating_sub(1).max(first)
            }
            Direction::Inwards => {
                let end = if last { clusters } else { (target / 2 * 2 + 4).min(clusters) };
                (target + 2).min(end)..end
            }
        };
        let mut first = 0;
        let seen: Vec<Seen> = (0..clusters)
            .map(|target| {
                let seen = Seen { sources: sources(target), first };
                first += seen.sources.len();
                seen
            })
            .collect();
        let mesh = assembly.mesh;
        let points: Vec<Vec<MeshPoint>> = (0..clusters)
            .map(|cluster| Span::new(cluster, width, mesh.cells()).points().map(|y| mesh.at(y)).collect())
            .collect();
        let Kernel { mu, nu, profile_factor, .. } = assembly.kernel;
        let kernel = |target: &MeshPoint, source: &MeshPoint| match direction {
            Direction::Outwards => profile_factor * mu * target.minus(source).powf(-nu) * source.slope,
            Direction::Inwards => -source.minus(target).powf(-mu),
        };
        let mut couplings = vec![0.0; first * TERMS * TERMS];
        let mut blocks: Vec<&mut [f64]> = Vec::with_capacity(clusters);
        let mut rest = couplings.as_mut_slice();
        for seen in &seen {
            let (block, others) = rest.split_at_mut(seen.sources.len() * TERMS * TERMS);
            blocks.push(block);
            rest = others;
        }
        blocks.into_par_iter().zip(&seen).enumerate().for_each(|(target, (block, seen))| {
            for (source, coupling) in seen.sources.clone().zip(block.chunks_exact_mut(TERMS * TERMS)) {
                for (from, row) in points[source].iter().zip(coupling.chunks_exact_mut(TERMS)) {
                    for (to, value) in points[target].iter().zip(row) {
                        *value = kernel(to, from);
                    }
                }
            }
        });
        let whole = Span::new(clusters - 1, width, mesh.cells());
        let at_last_halves = [0, 1].map(|half| {
            let half = Span::new(2 * (clusters - 1) + half, width / 2, mesh.cells());
            whole.polynomials(half.points().filter(|_| half.length > 0))
        });
        Self { clusters, at_last_halves, seen, couplings }
    }

    /// Adds what the clusters see of the moments.
    fn add(&self, moments: &[f64], field: &mut [f64]) {
        in_parallel(field, TERMS, |first, part| {
            for (seen, field) in self.seen[first..].iter().zip(part.chunks_exact_mut(TERMS)) {
                let couplings = self.couplings[TERMS * TERMS * seen.first..].chunks_exact(TERMS);
                let moments = &moments[TERMS * seen.sources.start..TERMS * seen.sources.end];
                for (kernel, moment) in couplings.zip(moments) {
                    for (value, kernel) in field.iter_mut().zip(kernel) {
                        *value += moment * kernel;
                    }
                }
            }
        });
    }
}

/// Chebyshev points of [0, 1].
fn chebyshev_points() -> impl Iterator<Item = f64> {
    let angle = |j: usize| std::f64::consts::PI * (j as f64 + 0.5) / TERMS as f64;
    (0..TERMS).map(move |j| (0.5 * angle(j)).sin().powi(2))
}

/// Lagrange polynomials on the Chebyshev points at `x`, by the barycentric formula (Berrut & Trefethen, SIAM Rev. 46:501, 2004).
fn polynomial_values(x: f64) -> [f64; TERMS] {
    let mut terms = [0.0; TERMS];
    for (j, (term, point)) in terms.iter_mut().zip(chebyshev_points()).enumerate() {
        let weight = (std::f64::consts::PI * (j as f64 + 0.5) / TERMS as f64).sin();
        let distance = x - point;
        if distance == 0.0 {
            return std::array::from_fn(|i| f64::from(u8::from(i == j)));
        }
        *term = if j % 2 == 0 { weight } else { -weight } / distance;
    }
    let sum: f64 = terms.iter().sum();
    terms.map(|term| term / sum)
}
