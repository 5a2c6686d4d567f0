//! Carrying an answer over to the next problem.
//!
//! From step to step contacts appear and vanish, so rows are identified by their [`ContactKey`], or by their
//! place where rows have none. A row not found starts closed or open by the sign of its offset, as in a solve
//! from nothing.

use crate::problem::{ContactKey, Problem};
use crate::solution::Solution;

/// Which contacts were closed, and with what force, in an earlier answer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WarmStart {
    /// Sorted by key where rows have keys, by row otherwise.
    entries: Vec<Entry>,
    by_key: bool,
    is_guess: bool,
    has_forces: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Entry {
    id: u64,
    force: f64,
    closed: bool,
    /// False for a place without an earlier row.
    known: bool,
}

/// What an earlier answer says about a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Earlier {
    /// Its force \[N\]; zero where only a guess of what is closed was made.
    pub force: f64,
    /// Whether a = 0 was enforced.
    pub closed: bool,
}

impl WarmStart {
    /// Knows nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Remembers the answer `solution` of `problem`, replacing what was remembered.
    ///
    /// # Panics
    ///
    /// If the answer is that of a problem with more rows.
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

    /// Replaces what is remembered by a guess: for each row, by its place, whether it is closed, if anything
    /// is known of it.
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

    /// Replaces what is remembered by a guess of the force of each row, by its place, if anything is known of it.
    pub fn guess_forces(&mut self, forces: impl IntoIterator<Item = Option<f64>>) {
        (self.by_key, self.is_guess, self.has_forces) = (false, true, true);
        self.entries.clear();
        self.entries.extend(forces.into_iter().map(|guess| {
            let force = guess.unwrap_or(0.0);
            Entry { id: 0, force, closed: force > 0.0, known: guess.is_some() }
        }));
    }

    /// What is remembered of a row of `problem`; `None` if that is nothing. For solvers of one's own.
    ///
    /// # Panics
    ///
    /// If there is no such row, and rows are found by their keys.
    #[must_use]
    pub fn of_row(&self, problem: &Problem, row: usize) -> Option<Earlier> {
        self.lookup(problem).find(row)
    }

    /// True if these are forces from which to look for the answer.
    pub(crate) fn has_forces(&self) -> bool {
        self.has_forces
    }

    /// False if these are rows that were closed in an answer, and then independent of each other.
    pub(crate) fn is_guess(&self) -> bool {
        self.is_guess
    }

    /// Makes this the warm start of a part of `problem`, the rows `rows`, identified by their place in it.
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
    /// What is remembered of a row.
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
                // Contacts mostly keep their order from step to step, so that the place is right at once.
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
