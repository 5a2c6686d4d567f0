//! The Delassus matrix A = J M^-1 J^T (n, n) [1/kg] of an impact's rows, row by row.
//!
//! Only rows that share a movable body have an entry, so that each row of a pile has a few, however many rows there
//! are.

use crate::row::CollisionRow;
use halfgap_collision::BodyId;

/// In place of an immovable body.
const NONE: u32 = u32::MAX;

/// Entries of A, each row's in ascending order of column.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Couplings {
    /// Where each row's entries begin in `entries`, and where the last row's end.
    start: Vec<usize>,
    /// Column and value [1/kg].
    entries: Vec<(u32, f64)>,
    diagonal: Vec<f64>,
    /// The movable bodies of each row.
    bodies: Vec<[u32; 2]>,
    /// The rows that turn a third body, with it.
    thirds: Vec<(u32, u32)>,
    /// Each movable body with each of its rows, sorted.
    of_bodies: Vec<(u32, u32)>,
}

impl Couplings {
    /// Forms the matrix anew.
    pub(super) fn set_rows(&mut self, rows: &[CollisionRow]) {
        self.bodies.clear();
        self.bodies
            .extend(rows.iter().map(|row| row.movable_bodies().map(|body| body.map_or(NONE, |id| id.0))));
        let third = |(row, data): (usize, &CollisionRow)| Some((row as u32, data.movable_third()?.0));
        self.thirds.clear();
        self.thirds.extend(rows.iter().enumerate().filter_map(third));
        self.list_rows_of_bodies();
        self.start.clear();
        self.start.push(0);
        self.entries.clear();
        self.diagonal.clear();
        for (index, row) in rows.iter().enumerate() {
            if let Ok(at) = self.thirds.binary_search_by_key(&(index as u32), |&(row, _)| row) {
                self.add_row_of_three(rows, index, self.thirds[at].1);
                continue;
            }
            let [first, second] = self.bodies[index].map(|body| rows_of(&self.of_bodies, body));
            let (mut p, mut q) = (first.iter().peekable(), second.iter().peekable());
            // Each list ascends; a row on both bodies is named in both.
            while let Some(next) = least(p.peek().map(|&&(_, row)| row), q.peek().map(|&&(_, row)| row)) {
                self.entries.push((next, row.coupling(&rows[next as usize])));
                p.next_if(|&&(_, row)| row == next);
                q.next_if(|&&(_, row)| row == next);
            }
            self.start.push(self.entries.len());
            self.diagonal.push(row.coupling(row));
        }
    }

    /// Adds the entries of a row that turns a third body.
    fn add_row_of_three(&mut self, rows: &[CollisionRow], index: usize, third: u32) {
        let [a, b] = self.bodies[index];
        let of_all = [a, b, third].into_iter().flat_map(|body| rows_of(&self.of_bodies, body));
        let mut reached: Vec<u32> = of_all.map(|&(_, row)| row).collect();
        reached.sort_unstable();
        reached.dedup();
        let row = &rows[index];
        self.entries.extend(reached.into_iter().map(|next| (next, row.coupling(&rows[next as usize]))));
        self.start.push(self.entries.len());
        self.diagonal.push(row.coupling(row));
    }

    fn list_rows_of_bodies(&mut self) {
        self.of_bodies.clear();
        for (row, bodies) in self.bodies.iter().enumerate() {
            let movable = bodies.iter().filter(|body| **body != NONE);
            self.of_bodies.extend(movable.map(|&body| (body, row as u32)));
        }
        self.of_bodies.extend(self.thirds.iter().map(|&(row, body)| (body, row)));
        self.of_bodies.sort_unstable();
        self.of_bodies.dedup();
    }

    /// The rows of a body, ascending.
    pub(super) fn rows_of_body(&self, body: BodyId) -> impl Iterator<Item = usize> + '_ {
        rows_of(&self.of_bodies, body.0).iter().map(|&(_, row)| row as usize)
    }

    /// The rows whose rates an impulse along `row` changes, with the change per impulse [1/kg].
    pub(super) fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.entries[self.start[row]..self.start[row + 1]]
            .iter()
            .map(|&(other, value)| (other as usize, value))
    }

    /// Change of a row's own rate per impulse [1/kg]; 0 if none of its bodies can move.
    pub(super) fn diagonal(&self, row: usize) -> f64 {
        self.diagonal[row]
    }

    /// Change of a row's rate per impulse along another row [1/kg].
    pub(super) fn between(&self, row: usize, other: usize) -> f64 {
        self.row(row).find(|&(column, _)| column == other).map_or(0.0, |(_, value)| value)
    }
}

/// The rows of a body, ascending.
fn rows_of(of_bodies: &[(u32, u32)], body: u32) -> &[(u32, u32)] {
    let from = of_bodies.partition_point(|&(other, _)| other < body);
    let count = of_bodies[from..].partition_point(|&(other, _)| other == body);
    &of_bodies[from..from + count]
}

/// The lesser of two numbers, either of which may be absent.
fn least(p: Option<u32>, q: Option<u32>) -> Option<u32> {
    match (p, q) {
        (Some(p), Some(q)) => Some(p.min(q)),
        (only, None) | (None, only) => only,
    }
}
