//! Independent groups of rows, solved one by one.
//!
//! Rows are coupled if they touch the same movable body; an immovable floor couples no rows. Found with union-find: R.
//! Tarjan, "Efficiency of a good but not linear set union algorithm", Journal of the ACM 22, 1975.

use crate::error::Infeasibility;
use crate::matrix::{Matrix, SparseMatrix};
use crate::problem::Problem;

/// No row, or not in the island.
const NONE: u32 = u32::MAX;

/// Number of islands that are kept as problems and have solvers of their own; all later islands share the last of these.
pub(crate) const KEPT: usize = 64;

/// The islands of a problem, and the first of them as problems of their own.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Islands {
    parent: Vec<u32>,
    /// Last row met, per column.
    met: Vec<u32>,
    /// Rows by island, and where each island begins.
    rows: Vec<u32>,
    start: Vec<u32>,
    island: Vec<u32>,
    /// The rows of bodies for which the islands were found: offsets, columns, coefficients, and inverse masses.
    known_start: Vec<usize>,
    known_column: Vec<usize>,
    known_value: Vec<f64>,
    known_mass: Vec<f64>,
    /// The first islands as problems, and one flag each: true if its coefficients are those of the whole.
    parts: Vec<Problem>,
    is_current: Vec<bool>,
    /// Index in the island of each row or column of the whole.
    local: Vec<u32>,
    /// The columns of an island that becomes a problem.
    columns: Vec<usize>,
}

impl Islands {
    /// Finds the islands and returns their number.
    pub(crate) fn find(&mut self, problem: &Problem) -> usize {
        let n = problem.len();
        if self.is_known(problem) {
            return self.start.len() - 2;
        }
        self.parent.clear();
        self.parent.extend(0..n as u32);
        match &problem.matrix {
            Matrix::Bodies(bodies) => {
                self.met.clear();
                self.met.resize(bodies.inverse_mass.len(), NONE);
                for row in 0..n {
                    for &k in bodies.rows.row(row).0.iter().filter(|k| bodies.inverse_mass[**k] > 0.0) {
                        match self.met[k] {
                            NONE => self.met[k] = row as u32,
                            other => self.join(row as u32, other),
                        }
                    }
                }
            }
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => {
                for row in 0..n {
                    let (columns, values) = matrix.row(row);
                    let coupled = columns.iter().zip(values).filter(|(_, v)| **v != 0.0);
                    coupled.for_each(|(&k, _)| self.join(row as u32, k as u32));
                }
            }
        }
        self.sort(n)
    }

    /// Whether the same rows touch the same movable bodies as last time. Stores those of `problem`.
    fn is_known(&mut self, problem: &Problem) -> bool {
        let Matrix::Bodies(bodies) = &problem.matrix else {
            self.known_start.clear();
            self.is_current.fill(false);
            return false;
        };
        let known = self.known_start == bodies.rows.start
            && self.known_column == bodies.rows.column
            && bodies.inverse_mass.iter().map(|w| *w > 0.0).eq(self.known_mass.iter().map(|w| *w > 0.0));
        let same = known && self.known_value == bodies.rows.value && self.known_mass == bodies.inverse_mass;
        if !known {
            self.known_start.clone_from(&bodies.rows.start);
            self.known_column.clone_from(&bodies.rows.column);
        }
        if !same {
            self.known_value.clone_from(&bodies.rows.value);
            self.known_mass.clone_from(&bodies.inverse_mass);
            self.is_current.fill(false);
        }
        known
    }

    fn root(&mut self, mut row: u32) -> u32 {
        while self.parent[row as usize] != row {
            let above = self.parent[self.parent[row as usize] as usize];
            self.parent[row as usize] = above;
            row = above;
        }
        row
    }

    /// The lower row becomes the root, so that islands are numbered by their first rows.
    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// Lists the rows by island.
    fn sort(&mut self, n: usize) -> usize {
        self.island.clear();
        let mut count = 0;
        for row in 0..n as u32 {
            let root = self.root(row);
            let island = if root == row {
                count += 1;
                count - 1
            } else {
                self.island[root as usize]
            };
            self.island.push(island);
        }
        let count = count as usize;
        self.start.clear();
        self.start.resize(count + 2, 0);
        self.island.iter().for_each(|&island| self.start[island as usize + 2] += 1);
        for i in 2..count + 2 {
            self.start[i] += self.start[i - 1];
        }
        self.rows.clear();
        self.rows.resize(n, 0);
        for row in 0..n {
            let next = &mut self.start[self.island[row] as usize + 1];
            self.rows[*next as usize] = row as u32;
            *next += 1;
        }
        count
    }

    /// The rows of an island, ascending.
    pub(crate) fn rows(&self, island: usize) -> &[u32] {
        &self.rows[self.start[island] as usize..self.start[island + 1] as usize]
    }

    /// Turns the proof that an island has no solution into one for the whole problem, whose scale may be larger.
    pub(crate) fn proof_of_whole(
        &self,
        problem: &Problem,
        island: usize,
        proof: Infeasibility,
    ) -> Infeasibility {
        let rows = self.rows(island);
        let mut direction = vec![0.0; problem.len()];
        rows.iter().zip(&proof.direction).for_each(|(&row, z)| direction[row as usize] = *z);
        let own = scale(problem, rows.iter().map(|&row| row as usize));
        let contradiction = proof.contradiction * own / scale(problem, 0..problem.len());
        Infeasibility { row: rows[proof.row] as usize, direction, contradiction, ..proof }
    }

    /// An island as a problem of its own, without keys.
    pub(crate) fn part(&mut self, problem: &Problem, island: usize) -> &Problem {
        let slot = island.min(KEPT - 1);
        if self.parts.len() <= slot {
            self.parts.resize_with(slot + 1, Problem::default);
            self.is_current.resize(slot + 1, false);
        }
        let rows = &self.rows[self.start[island] as usize..self.start[island + 1] as usize];
        let part = &mut self.parts[slot];
        part.offset.clear();
        part.offset.extend(rows.iter().map(|&row| problem.offset[row as usize]));
        part.bilateral.clear();
        part.bilateral.extend(rows.iter().map(|&row| problem.bilateral[row as usize]));
        // Several islands share the last slot, so it is never current.
        let was_current = std::mem::replace(&mut self.is_current[slot], island + 1 < KEPT);
        if was_current {
            return part;
        }
        part.keys.clear();
        let (source, masses) = match &problem.matrix {
            Matrix::Bodies(bodies) => (&bodies.rows, Some(&bodies.inverse_mass)),
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => (matrix, None),
        };
        if std::mem::discriminant(&part.matrix) != std::mem::discriminant(&problem.matrix) {
            part.matrix = problem.matrix.clone();
        }
        let (target, target_masses) = match &mut part.matrix {
            Matrix::Bodies(bodies) => (&mut bodies.rows, Some(&mut bodies.inverse_mass)),
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => (matrix, None),
        };
        let columns = masses.map_or(problem.len(), |masses| masses.len());
        self.local.resize(columns.max(self.local.len()), NONE);
        self.columns.clear();
        if let (Some(from), Some(to)) = (masses, target_masses) {
            list_columns(rows, source, &mut self.local, &mut self.columns);
            to.clear();
            to.extend(self.columns.iter().map(|&k| from[k]));
        } else {
            // A matrix has the same rows and columns.
            self.columns.extend(rows.iter().map(|&row| row as usize));
        }
        self.columns.iter().enumerate().for_each(|(at, &k)| self.local[k] = at as u32);
        target.start.truncate(1);
        target.column.clear();
        target.value.clear();
        for &row in rows {
            let (columns, values) = source.row(row as usize);
            for (&k, &v) in columns.iter().zip(values) {
                if self.local[k] != NONE {
                    target.column.push(self.local[k] as usize);
                    target.value.push(v);
                }
            }
            target.start.push(target.column.len());
        }
        // Only the columns touched are reset, as there may be as many islands as bodies.
        self.columns.iter().for_each(|&k| self.local[k] = NONE);
        part
    }
}

/// The largest scaled offset of some rows, or 1.
fn scale(problem: &Problem, rows: impl Iterator<Item = usize>) -> f64 {
    let largest =
        rows.fold(0.0, |most: f64, row| most.max((problem.offset[row] / problem.row_scale(row)).abs()));
    if largest > 0.0 { largest } else { 1.0 }
}

/// Lists the columns of some rows in their own order, so that they ascend within each row as they do in the whole, and
/// marks them as local.
fn list_columns(rows: &[u32], source: &SparseMatrix, local: &mut [u32], columns: &mut Vec<usize>) {
    for &row in rows {
        for &k in source.row(row as usize).0 {
            if local[k] == NONE {
                local[k] = 0;
                columns.push(k);
            }
        }
    }
    columns.sort_unstable();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ProblemError;

    #[test]
    fn a_floor_couples_nothing() -> Result<(), ProblemError> {
        // Columns 0 and 1 move, 2 is the floor; rows 0 and 2 touch body 0, row 1 body 1.
        let rows = [(0, 0, 1.0), (0, 2, -1.0), (1, 1, 1.0), (1, 2, -1.0), (2, 0, 1.0)];
        let problem = Problem::from_rows(&rows, &[1.0, 1.0, 0.0], &[-1.0, -2.0, -3.0])?;
        let mut islands = Islands::default();
        assert_eq!(islands.find(&problem), 2);
        assert_eq!((islands.rows(0), islands.rows(1)), (&[0, 2][..], &[1][..]));
        assert_eq!(islands.part(&problem, 0).offset(), [-1.0, -3.0]);
        Ok(())
    }

    #[test]
    fn the_columns_of_a_part_ascend_as_those_of_the_whole() -> Result<(), ProblemError> {
        // The first row touches the last body, and a floor, column 1, that the third row touches, too.
        let rows = [(0, 1, 3.0), (0, 3, 1.0), (1, 2, 2.0), (2, 0, 5.0), (2, 1, 6.0), (2, 3, 4.0)];
        let problem = Problem::from_rows(&rows, &[1.0, 0.0, 2.0, 4.0], &[-1.0, -2.0, -3.0])?;
        let mut islands = Islands::default();
        assert_eq!(islands.find(&problem), 2);
        let rows = [(0, 1, 3.0), (0, 2, 1.0), (1, 0, 5.0), (1, 1, 6.0), (1, 2, 4.0)];
        let part = Problem::from_rows(&rows, &[1.0, 0.0, 4.0], &[-1.0, -3.0])?;
        assert_eq!(*islands.part(&problem, 0), part);
        Ok(())
    }

    #[test]
    fn parts_follow_the_whole() -> Result<(), ProblemError> {
        let masses = [1.0, 1.0];
        let whole = |value: f64, offset: f64| {
            Problem::from_rows(&[(0, 0, value), (1, 1, 2.0), (2, 0, 3.0)], &masses, &[offset, -2.0, -3.0])
        };
        let mut islands = Islands::default();
        // The offsets change, then a coefficient, then back.
        for (value, offset) in [(1.0, -1.0), (1.0, -4.0), (5.0, -4.0), (1.0, -1.0)] {
            let problem = whole(value, offset)?;
            assert_eq!(islands.find(&problem), 2);
            let part = Problem::from_rows(&[(0, 0, value), (1, 0, 3.0)], &[1.0], &[offset, -3.0])?;
            assert_eq!(*islands.part(&problem, 0), part);
            let other = Problem::from_rows(&[(0, 0, 2.0)], &[1.0], &[-2.0])?;
            assert_eq!(*islands.part(&problem, 1), other);
        }
        Ok(())
    }
}
