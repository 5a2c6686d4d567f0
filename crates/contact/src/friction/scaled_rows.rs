//! Rows of all kinds, scaled, as modes see them: what each measures and along what its force acts.
//!
//! A problem of bodies has a column for each coordinate, scaled by the root of its inverse mass; a problem given by a
//! matrix A has a column for each row, with A_i as what row i measures and the unit vector as its direction. Either way
//! the motion is v = Σ d_j u_j and the scaled acceleration a_i = c_i v + b_i. Row i is scaled by s_i, the length of its c
//! (of bodies) or the root of its diagonal, to u_i = s_i f_i and a_i / s_i.
//!
//! *Invariant*: rows of the problem that are plain cost no more here than their entries.

use super::body_order::BodyOrder;
use crate::kind::RowKind;
use crate::matrix::{Matrix, SparseMatrix};
use crate::problem::Problem;

/// Sparse rows: entries end to end.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Entries {
    start: Vec<u32>,
    entry: Vec<(u32, f64)>,
}

impl Entries {
    fn clear(&mut self) {
        self.start.clear();
        self.start.push(0);
        self.entry.clear();
    }

    fn end_row(&mut self) {
        self.start.push(self.entry.len() as u32);
    }

    #[inline]
    pub(super) fn row(&self, row: usize) -> &[(u32, f64)] {
        &self.entry[self.start[row] as usize..self.start[row + 1] as usize]
    }

    /// The product of a row with a vector.
    #[inline]
    pub(super) fn times(&self, row: usize, vector: &[f64]) -> f64 {
        self.row(row).iter().map(|&(k, value)| value * vector[k as usize]).sum()
    }

    /// Adds a multiple of a row to a vector.
    #[inline]
    pub(super) fn add_to(&self, row: usize, factor: f64, vector: &mut [f64]) {
        self.row(row).iter().for_each(|&(k, value)| vector[k as usize] += factor * value);
    }
}

/// What bounds the scaled force of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum Bound {
    /// Zero from below.
    Unilateral,
    /// Nothing.
    Bilateral,
    /// Constants.
    Constants { least: f64, most: f64 },
    /// A coefficient times the scaled force of another row.
    Friction { normal: u32, coefficient: f64 },
}

/// The scaled rows of a problem.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct ScaledRows {
    /// c, and d where that differs (all rows then).
    measured: Entries,
    direction: Entries,
    has_directions: bool,
    /// Scaled b, s and the bound of each row.
    pub(super) offset: Vec<f64>,
    pub(super) scale: Vec<f64>,
    pub(super) bound: Vec<Bound>,
    /// Rows bounded by friction, as (normal row, row), ascending.
    pub(super) friction: Vec<(u32, u32)>,
    /// Number of columns, and the first column of each one's envelope.
    pub(super) first: Vec<u32>,
    order: BodyOrder,
    /// Root of the inverse mass by column.
    root: Vec<f64>,
}

impl ScaledRows {
    /// Loads a problem.
    pub(super) fn load(&mut self, problem: &Problem) {
        self.measured.clear();
        self.direction.clear();
        self.scale.clear();
        match &problem.matrix {
            Matrix::Bodies(bodies) => {
                self.order.prepare(&bodies.rows, &bodies.inverse_mass);
                self.first.clear();
                self.first.extend_from_slice(&self.order.first);
                self.load_bodies(problem, &bodies.rows, &bodies.inverse_mass);
            }
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => self.load_matrix(matrix),
        }
        self.offset.clear();
        self.offset.extend(problem.offset.iter().zip(&self.scale).map(|(b, s)| b / s));
        self.load_bounds(problem);
        self.widen();
    }

    /// Widens the envelope to what a row measures and pushes, a normal row with its friction.
    fn widen(&mut self) {
        let directions = if self.has_directions { &self.direction } else { &self.measured };
        let turned = (0..self.scale.len() as u32).filter(|_| self.has_directions).map(|row| (row, row));
        for (measuring, pushing) in turned.chain(self.friction.iter().copied()) {
            let (pushed, measured) =
                (directions.row(pushing as usize), self.measured.row(measuring as usize));
            let columns = || pushed.iter().chain(measured).map(|entry| entry.0);
            let Some(least) = columns().min() else { continue };
            columns().for_each(|k| self.first[k as usize] = self.first[k as usize].min(least));
        }
    }

    fn load_bodies(&mut self, problem: &Problem, rows: &SparseMatrix, inverse_mass: &[f64]) {
        self.root.clear();
        self.root.extend(inverse_mass.iter().map(|w| w.sqrt()));
        self.has_directions = problem.further.has_directions();
        for row in 0..rows.rows() {
            let begin = self.measured.entry.len();
            let (columns, values) = rows.row(row);
            let mut square = 0.0;
            for (&k, &value) in columns.iter().zip(values) {
                if inverse_mass[k] > 0.0 {
                    let value = value * self.root[k];
                    square += value * value;
                    self.measured.entry.push((self.order.place[k], value));
                }
            }
            let scale = if square > 0.0 { square.sqrt() } else { 1.0 };
            self.measured.entry[begin..].iter_mut().for_each(|entry| entry.1 /= scale);
            self.measured.end_row();
            self.scale.push(scale);
            if self.has_directions {
                self.load_direction(problem, row, scale, inverse_mass);
            }
        }
    }

    fn load_direction(&mut self, problem: &Problem, row: usize, scale: f64, inverse_mass: &[f64]) {
        match problem.further.direction(row) {
            Some(direction) => {
                for (k, value) in direction.entries().filter(|&(k, _)| inverse_mass[k] > 0.0) {
                    self.direction.entry.push((self.order.place[k], value * self.root[k] / scale));
                }
            }
            None => self.direction.entry.extend_from_slice(self.measured.row(row)),
        }
        self.direction.end_row();
    }

    fn load_matrix(&mut self, matrix: &SparseMatrix) {
        let n = matrix.rows();
        self.has_directions = true;
        let diagonal = (0..n).map(|row| matrix.entry(row, row).abs());
        self.scale.extend(diagonal.map(|d| if d > 0.0 { d.sqrt() } else { 1.0 }));
        self.first.clear();
        self.first.extend(0..n as u32);
        for row in 0..n {
            let (columns, values) = matrix.row(row);
            for (&k, &value) in columns.iter().zip(values).filter(|(_, value)| **value != 0.0) {
                self.measured.entry.push((k as u32, value / self.scale[row] / self.scale[k]));
            }
            self.measured.end_row();
            self.direction.entry.push((row as u32, 1.0));
            self.direction.end_row();
        }
    }

    fn load_bounds(&mut self, problem: &Problem) {
        let scale = &self.scale;
        self.bound.clear();
        self.friction.clear();
        let plain = |bilateral: &bool| if *bilateral { Bound::Bilateral } else { Bound::Unilateral };
        self.bound.extend(problem.bilateral.iter().map(plain));
        for (row, kind) in problem.further.kinds() {
            self.bound[row] = match kind {
                RowKind::Unilateral => Bound::Unilateral,
                RowKind::Bilateral => Bound::Bilateral,
                RowKind::Bounded { least, most } => {
                    Bound::Constants { least: least * scale[row], most: most * scale[row] }
                }
                RowKind::Friction { normal, coefficient } => {
                    self.friction.push((normal as u32, row as u32));
                    let coefficient = coefficient * scale[row] / scale[normal];
                    Bound::Friction { normal: normal as u32, coefficient }
                }
            };
        }
        self.friction.sort_unstable();
    }

    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.offset.len()
    }

    /// The load: the largest scaled offset, or least force where that must not be zero.
    pub(super) fn load_size(&self) -> f64 {
        let least = |bound: &Bound| match *bound {
            Bound::Constants { least, most } => least.max(-most).max(0.0),
            _ => 0.0,
        };
        let offsets = self.offset.iter().map(|b| b.abs());
        offsets.chain(self.bound.iter().map(least)).fold(0.0, f64::max)
    }

    /// What the rows measure.
    #[inline]
    pub(super) fn measured(&self) -> &Entries {
        &self.measured
    }

    /// Along what the forces of the rows act.
    #[inline]
    pub(super) fn directions(&self) -> &Entries {
        if self.has_directions { &self.direction } else { &self.measured }
    }

    /// The rows bounded by the friction of a normal row.
    #[inline]
    pub(super) fn friction_of(&self, normal: usize) -> &[(u32, u32)] {
        let begin = self.friction.partition_point(|&(n, _)| (n as usize) < normal);
        let rest = &self.friction[begin..];
        let count = rest.iter().take_while(|&&(n, _)| n as usize == normal).count();
        &rest[..count]
    }
}
