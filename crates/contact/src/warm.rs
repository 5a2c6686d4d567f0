//! Carrying an answer over to the next problem.
//!
//! Contacts appear and vanish from step to step, so rows are identified by their [`ContactKey`], or by index if any row
//! lacks a key. A row that is not found starts closed or open by its offset, as in a solve without an earlier answer.

use crate::problem::{ContactKey, Problem};
use crate::solution::Solution;

/// The closed rows and forces of an earlier answer, or a guess of them, as the start of a later solve.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct WarmStart {
    /// Sorted by key if all rows have keys, by row otherwise.
    entries: Vec<Entry>,
    by_key: bool,
    is_guess: bool,
    has_forces: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Entry {
    id: u64,
    force: f64,
    closed: bool,
    /// False for a row of which nothing is known.
    known: bool,
}

/// The state of a row in an earlier answer or guess.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Earlier {
    /// Its force \[N\], or impulse [N·s]; zero if only the closed rows were guessed.
    pub force: f64,
    /// True if the row was closed: a = 0 was enforced.
    pub closed: bool,
}

impl WarmStart {
    /// Makes a warm start that knows no rows.
    #[must_use]
    #[inline]
    pub fn new() -> Self {
        Self::default()
    }

    /// Stores the answer `solution` of `problem` in place of all that was stored before.
    ///
    /// # Panics
    ///
    /// If `solution` has more rows than `problem` and all rows of `problem` have keys, or if `solution.active` names a
    /// row that `solution` does not have.
    #[inline]
    pub fn remember(&mut self, problem: &Problem, solution: &Solution) {
        (self.by_key, self.is_guess, self.has_forces) = (has_keys(problem), false, false);
        self.entries.clear();
        self.entries.extend(solution.force.iter().enumerate().map(|(row, &force)| {
            let id = if self.by_key { problem.keys[row].0 } else { row as u64 };
            Entry { id, force, closed: false, known: true }
        }));
        for &row in &solution.active {
            self.entries[row].closed = true;
        }
        if self.by_key {
            self.entries.sort_unstable_by_key(|entry| entry.id);
        }
    }

    /// Stores a guess of the closed rows in place of all that was stored before: one flag per row, in the order of
    /// rows; `None` for a row of which nothing is known. A problem all of whose rows have keys ignores it.
    #[inline]
    pub fn guess(&mut self, closed: impl IntoIterator<Item = Option<bool>>) {
        (self.by_key, self.is_guess, self.has_forces) = (false, true, false);
        self.entries.clear();
        self.entries.extend(closed.into_iter().map(|closed| Entry {
            id: 0,
            force: 0.0,
            closed: closed == Some(true),
            known: closed.is_some(),
        }));
    }

    /// Stores a guess of the forces \[N\] (or impulses [N·s]) in place of all that was stored before: one per row, in
    /// the order of rows; `None` for a row of which nothing is known, as a number that is not finite. Rows with a positive
    /// force count as closed. A problem all of whose rows have keys ignores the guess.
    #[inline]
    pub fn guess_forces(&mut self, forces: impl IntoIterator<Item = Option<f64>>) {
        (self.by_key, self.is_guess, self.has_forces) = (false, true, true);
        self.entries.clear();
        self.entries.extend(forces.into_iter().map(|guess| {
            let guess = guess.filter(|force| force.is_finite());
            let force = guess.unwrap_or(0.0);
            Entry { id: 0, force, closed: force > 0.0, known: guess.is_some() }
        }));
    }

    /// Looks up a row of `problem`; `None` if nothing is known of it. For solvers outside this crate.
    ///
    /// # Panics
    ///
    /// If there is no such row and rows are found by their keys.
    #[must_use]
    #[inline]
    pub fn of_row(&self, problem: &Problem, row: usize) -> Option<Earlier> {
        self.lookup(problem).find(row)
    }

    /// True after [`guess_forces`](Self::guess_forces): the solve may start from these forces.
    pub(crate) fn has_forces(&self) -> bool {
        self.has_forces
    }

    /// False if the closed rows are those of an answer, which were independent of each other.
    pub(crate) fn is_guess(&self) -> bool {
        self.is_guess
    }

    /// Makes this the warm start of the part of `problem` that consists of `rows`, identified by their index in the
    /// part.
    pub(crate) fn restrict(&mut self, whole: &WarmStart, problem: &Problem, rows: &[u32]) {
        let lookup = whole.lookup(problem);
        (self.by_key, self.is_guess, self.has_forces) = (false, whole.is_guess, whole.has_forces);
        self.entries.clear();
        let unknown = Entry { id: 0, force: 0.0, closed: false, known: false };
        self.entries.extend(rows.iter().map(|&row| lookup.entry(row as usize).unwrap_or(unknown)));
    }

    /// Prepares for looking up the rows of `problem`.
    pub(crate) fn lookup<'a>(&'a self, problem: &'a Problem) -> Lookup<'a> {
        let keys = if has_keys(problem) { Some(problem.keys.as_slice()) } else { None };
        Lookup { warm: self, keys }
    }
}

/// A warm start and the identities of the rows of one problem.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lookup<'a> {
    warm: &'a WarmStart,
    keys: Option<&'a [ContactKey]>,
}

impl Lookup<'_> {
    /// The earlier state of a row, if it is known.
    #[inline]
    pub(crate) fn find(&self, row: usize) -> Option<Earlier> {
        let entry = self.entry(row).filter(|entry| entry.known);
        entry.map(|Entry { force, closed, .. }| Earlier { force, closed })
    }

    /// The entry of a row, known or not.
    #[inline]
    fn entry(&self, row: usize) -> Option<Entry> {
        let entries = &self.warm.entries;
        match (self.warm.by_key, self.keys) {
            (true, Some(keys)) => {
                let id = keys[row].0;
                // Contacts mostly keep their order from step to step, so that the entry at the row's own index is
                // mostly the one.
                match entries.get(row) {
                    Some(entry) if entry.id == id => Some(*entry),
                    _ => entries.binary_search_by_key(&id, |entry| entry.id).ok().map(|k| entries[k]),
                }
            }
            (false, None) => entries.get(row).copied(),
            _ => None,
        }
    }
}

fn has_keys(problem: &Problem) -> bool {
    problem.keys.len() == problem.len() && problem.keys.iter().all(|&key| key != ContactKey::NONE)
}
