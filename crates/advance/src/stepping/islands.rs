//! Bodies that rows couple: islands, each with its bodies and rows, solved one after the other.

use crate::rigid::Forest;
use crate::stepping::bodies::Bodies;
use crate::stepping::rows::Row;

/// The islands of a step.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Islands {
    forest: Forest,
    /// Bodies and rows, island by island.
    pub(super) bodies: Vec<u32>,
    pub(super) rows: Vec<u32>,
    /// End of each island in both lists.
    pub(super) ends: Vec<[u32; 2]>,
    island_of: Vec<u32>,
    next: Vec<[u32; 2]>,
}

impl Islands {
    /// Lists the islands of all movable bodies that are awake. They come in the order of their least bodies, and keep the order of
    /// bodies and rows.
    pub(super) fn find(&mut self, bodies: &Bodies, is_awake: impl Fn(usize) -> bool, rows: &[Row]) {
        let count = bodies.count();
        self.forest.reset(count);
        let moves = |place: usize| place < count && !bodies.natures[place].body.is_fixed();
        for row in rows {
            let [a, b] = row.ends();
            if moves(a) && moves(b) {
                self.forest.join(a, b);
            }
            if row.third().is_some() {
                let mut ends = row.all_ends().filter(|&place| moves(place));
                if let Some(first) = ends.next() {
                    ends.for_each(|other| {
                        self.forest.join(first, other);
                    });
                }
            }
        }
        self.island_of.clear();
        self.island_of.resize(count, u32::MAX);
        self.next.clear();
        for place in (0..count).filter(|&place| moves(place) && is_awake(place)) {
            let root = self.forest.root(place);
            if self.island_of[root] == u32::MAX {
                self.island_of[root] = self.next.len() as u32;
                self.next.push([0, 0]);
            }
            self.island_of[place] = self.island_of[root];
            self.next[self.island_of[root] as usize][0] += 1;
        }
        let of_row = |row: &Row| {
            let [a, b] = row.ends();
            match row.third() {
                Some(third) if !(moves(a) || moves(b)) => third.place as usize,
                _ if moves(a) => a,
                _ => b,
            }
        };
        for row in rows {
            self.next[self.island_of[of_row(row)] as usize][1] += 1;
        }
        let mut sums = [0, 0];
        self.ends.clear();
        for next in &mut self.next {
            let counts = *next;
            *next = sums;
            sums = [sums[0] + counts[0], sums[1] + counts[1]];
            self.ends.push(sums);
        }
        self.bodies.clear();
        self.bodies.resize(sums[0] as usize, 0);
        self.rows.clear();
        self.rows.resize(sums[1] as usize, 0);
        for place in (0..count).filter(|&place| moves(place) && is_awake(place)) {
            let next = &mut self.next[self.island_of[place] as usize][0];
            self.bodies[*next as usize] = place as u32;
            *next += 1;
        }
        for (index, row) in rows.iter().enumerate() {
            let next = &mut self.next[self.island_of[of_row(row)] as usize][1];
            self.rows[*next as usize] = index as u32;
            *next += 1;
        }
    }

    pub(super) fn count(&self) -> usize {
        self.ends.len()
    }

    /// Bodies and rows of an island.
    pub(super) fn get(&self, island: usize) -> (&[u32], &[u32]) {
        let [b0, r0] = if island == 0 { [0, 0] } else { self.ends[island - 1] };
        let [b1, r1] = self.ends[island];
        (&self.bodies[b0 as usize..b1 as usize], &self.rows[r0 as usize..r1 as usize])
    }
}
