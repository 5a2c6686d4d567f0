//! An order of bodies that keeps the envelope of a matrix of their coordinates narrow.
//!
//! Bodies are numbered by the reverse of a breadth-first walk through the graph of rows between them, from a body at an
//! end of it: E. Cuthill, J. McKee, "Reducing the bandwidth of sparse symmetric matrices", ACM 1969; A. George, J. Liu,
//! "An implementation of a pseudoperipheral node finder", ACM TOMS 5, 1979.

use crate::matrix::SparseMatrix;

/// Coordinates of a body.
const COORDINATES: usize = 3;
/// Walks by which an end of the graph is looked for: the first finds one far from where it began, the next one far from
/// that; more gain nothing on walls and heaps.
const WALKS: usize = 2;

/// The place of each column in the order, kept while the pattern of the rows stays the same.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct BodyOrder {
    /// Place of each column; of columns without inverse mass it means nothing.
    pub(super) place: Vec<u32>,
    /// First place of the envelope of each place.
    pub(super) first: Vec<u32>,
    known_start: Vec<usize>,
    known_column: Vec<usize>,
    known_movable: Vec<bool>,
    /// Pairs of bodies that share a row, both ways, ascending; and where those of each body begin.
    pairs: Vec<(u32, u32)>,
    begin: Vec<u32>,
    walk: Vec<u32>,
    is_seen: Vec<bool>,
}

impl BodyOrder {
    /// Finds the order for rows of bodies, unless their pattern is the last one.
    pub(super) fn prepare(&mut self, rows: &SparseMatrix, inverse_mass: &[f64]) {
        let movable = inverse_mass.iter().map(|w| *w > 0.0);
        let is_known = self.known_start == rows.start
            && self.known_column == rows.column
            && movable.clone().eq(self.known_movable.iter().copied());
        if is_known {
            return;
        }
        self.known_start.clone_from(&rows.start);
        self.known_column.clone_from(&rows.column);
        self.known_movable.clear();
        self.known_movable.extend(movable);
        self.list_pairs(rows);
        self.order();
        self.find_places(rows);
    }

    fn list_pairs(&mut self, rows: &SparseMatrix) {
        let bodies = self.known_movable.len().div_ceil(COORDINATES);
        self.pairs.clear();
        for row in 0..rows.rows() {
            let columns = || rows.row(row).0.iter().filter(|k| self.known_movable[**k]);
            for &k in columns() {
                for &other in columns().filter(|other| **other / COORDINATES != k / COORDINATES) {
                    self.pairs.push(((k / COORDINATES) as u32, (other / COORDINATES) as u32));
                }
            }
        }
        self.pairs.sort_unstable();
        self.pairs.dedup();
        self.begin.clear();
        self.begin.extend((0..=bodies as u32).map(|body| self.pairs.partition_point(|p| p.0 < body) as u32));
    }

    /// Lists the bodies of one part of the graph from `first` on, breadth first, at the end of the walk.
    fn walk_from(&mut self, first: u32) {
        let begin = self.walk.len();
        self.is_seen[first as usize] = true;
        self.walk.push(first);
        let mut at = begin;
        while let Some(&body) = self.walk.get(at) {
            for k in self.begin[body as usize]..self.begin[body as usize + 1] {
                let other = self.pairs[k as usize].1;
                if !std::mem::replace(&mut self.is_seen[other as usize], true) {
                    self.walk.push(other);
                }
            }
            at += 1;
        }
    }

    fn order(&mut self) {
        let bodies = self.begin.len() - 1;
        self.walk.clear();
        self.is_seen.clear();
        self.is_seen.resize(bodies, false);
        for body in 0..bodies as u32 {
            if self.is_seen[body as usize] {
                continue;
            }
            let begin = self.walk.len();
            let mut first = body;
            for _ in 0..WALKS {
                self.walk_from(first);
                let part = self.walk.drain(begin..);
                let mut last = first;
                for body in part {
                    self.is_seen[body as usize] = false;
                    last = body;
                }
                first = last;
            }
            self.walk_from(first);
        }
        self.walk.reverse();
    }

    fn find_places(&mut self, rows: &SparseMatrix) {
        self.place.clear();
        self.place.resize(self.known_movable.len(), 0);
        let mut next = 0;
        for &body in &self.walk {
            let first = COORDINATES * body as usize;
            for k in first..(first + COORDINATES).min(self.known_movable.len()) {
                if self.known_movable[k] {
                    self.place[k] = next;
                    next += 1;
                }
            }
        }
        self.first.clear();
        self.first.extend(0..next);
        for row in 0..rows.rows() {
            let columns = || rows.row(row).0.iter().filter(|k| self.known_movable[**k]);
            let Some(least) = columns().map(|&k| self.place[k]).min() else { continue };
            for &k in columns() {
                let first = &mut self.first[self.place[k] as usize];
                *first = (*first).min(least);
            }
        }
    }
}
