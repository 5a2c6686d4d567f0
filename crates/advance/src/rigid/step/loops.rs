//! Whether connectors close a loop: only then may what they hold come to depend on each other as they move.
//!
//! A group's connectors are edges between its bodies and all that cannot move, which is one. Contacts do not count: where
//! two of them, or one and a connector, come to hold the same, one of them lets go.

use super::rows::{HeldRow, RowSource};

/// Bodies as sets that are joined; the last stands for all that cannot move.
#[derive(Clone, Debug, Default)]
pub(crate) struct Loops {
    /// Another body of the same set, or itself.
    next: Vec<usize>,
    is_closed: bool,
}

impl Loops {
    /// Forgets what was found.
    pub(crate) fn clear(&mut self) {
        self.is_closed = false;
    }

    /// Finds whether connectors close one among so many bodies, from their rows and the places of the two bodies of each.
    pub(crate) fn find(&mut self, bodies: usize, rows: &[HeldRow], sides: &[[Option<u32>; 2]]) {
        self.is_closed = false;
        let is_first = |row: &HeldRow| row.bilateral && matches!(row.source, RowSource::Connector(_, 0));
        let first_rows = rows.iter().zip(sides).filter(|(row, _)| is_first(row));
        self.next.clear();
        self.next.extend(0..=bodies);
        for (_, sides) in first_rows {
            let [a, b] = sides.map(|place| self.root(place.map_or(bodies, |place| place as usize)));
            self.is_closed |= a == b;
            self.next[a] = b;
        }
    }

    /// True if connectors close a loop.
    pub(crate) fn any(&self) -> bool {
        self.is_closed
    }

    /// The body that stands for the set of another, to which the way becomes shorter each time.
    fn root(&mut self, mut body: usize) -> usize {
        while self.next[body] != body {
            self.next[body] = self.next[self.next[body]];
            body = self.next[body];
        }
        body
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfgap_collision::{BodyId, ConnectorId};

    /// Whether connectors between such places of three bodies close a loop, each of them with two rows.
    fn any(ends: &[[Option<u32>; 2]]) -> bool {
        let row = |connector: usize, index: usize| HeldRow {
            source: RowSource::Connector(ConnectorId(connector as u32), index),
            bodies: [BodyId::WORLD; 2],
            bilateral: true,
            gap: 0.0,
            hint: None,
            leans: false,
            is_lifted: false,
        };
        let rows: Vec<_> =
            (0..ends.len()).flat_map(|connector| [row(connector, 0), row(connector, 1)]).collect();
        let sides: Vec<_> = ends.iter().flat_map(|&ends| [ends, ends]).collect();
        let mut loops = Loops::default();
        loops.find(3, &rows, &sides);
        loops.any()
    }

    #[test]
    fn what_comes_back_is_a_loop() {
        // A chain from the world, a tree, and two chains that each hang by themselves.
        assert!(!any(&[[None, Some(0)], [Some(0), Some(1)], [Some(2), Some(1)]]));
        assert!(!any(&[[Some(1), Some(0)], [Some(1), Some(2)], [Some(1), None]]));
        assert!(!any(&[[None, Some(0)], [None, Some(1)], [None, Some(2)]]));
        // By way of bodies, of what cannot move, and of two connectors between the same.
        assert!(any(&[[Some(0), Some(1)], [Some(1), Some(2)], [Some(2), Some(0)]]));
        assert!(any(&[[None, Some(0)], [Some(0), Some(1)], [Some(1), None]]));
        assert!(any(&[[None, Some(2)], [Some(2), None]]));
        assert!(!any(&[]));
    }
}
