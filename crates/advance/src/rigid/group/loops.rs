//! Detection of closed loops of connectors: only there can the Jacobian of the connectors' rows lose rank as they move,
//! in a singular configuration (see `singular`).
//!
//! The connectors of a group are the edges of a graph whose nodes are its bodies, with one node for all bodies that
//! cannot move. Contacts do not count: where rows of two contacts, or of a contact and a connector, become dependent,
//! one contact is released.

use crate::rigid::contacts::rows::{ActiveRow, RowSource};
use crate::rigid::forest::Forest;
use halfgap_contact::ThirdSide;

/// Whether the connectors of a group close a loop.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Loops {
    /// Bodies that connectors join; the last place stands for all bodies that cannot move.
    joined: Forest,
    is_closed: bool,
}

impl Loops {
    /// Forgets the loops of another group.
    pub(crate) fn clear(&mut self) {
        self.is_closed = false;
    }

    /// Finds whether connectors close a loop among a number of bodies, from the rows and the places of the two bodies
    /// of each; `None` for a body that cannot move.
    pub(crate) fn find(&mut self, bodies: usize, rows: &[ActiveRow], sides: &[[Option<u32>; 2]]) {
        self.is_closed = false;
        let is_first = |row: &ActiveRow| row.bilateral && matches!(row.source, RowSource::Connector(_, 0));
        let first_rows = rows.iter().zip(sides).filter(|(row, _)| is_first(row));
        self.joined.reset(bodies + 1);
        for (_, sides) in first_rows {
            let [a, b] = sides.map(|place| place.map_or(bodies, |place| place as usize));
            self.is_closed |= !self.joined.join(a, b);
        }
    }

    /// Joins the third bodies of rows, too, given with the sides of all rows.
    pub(crate) fn join_thirds(&mut self, bodies: usize, sides: &[[Option<u32>; 2]], thirds: &[ThirdSide]) {
        for third in thirds {
            let [a, _] = sides[third.row as usize];
            let a = a.map_or(bodies, |place| place as usize);
            self.is_closed |= !self.joined.join(a, third.body as usize);
        }
    }

    /// True if connectors close a loop.
    pub(crate) fn any(&self) -> bool {
        self.is_closed
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::rigid::contacts::friction::Grip;
    use halfgap_collision::{BodyId, ConnectorId};

    /// True if connectors of two rows each, between the given places of three bodies, close a loop.
    fn any(ends: &[[Option<u32>; 2]]) -> bool {
        let row = |connector: usize, index: usize| ActiveRow {
            source: RowSource::Connector(ConnectorId(connector as u32), index),
            bodies: [BodyId::WORLD; 2],
            third: None,
            bilateral: true,
            gap: 0.0,
            hint: None,
            leans: false,
            grips: [Grip::Smooth; 2],
            load: [0.0; 3],
        };
        let rows: Vec<_> =
            (0..ends.len()).flat_map(|connector| [row(connector, 0), row(connector, 1)]).collect();
        let sides: Vec<_> = ends.iter().flat_map(|&ends| [ends, ends]).collect();
        let mut loops = Loops::default();
        loops.find(3, &rows, &sides);
        loops.any()
    }

    #[test]
    fn a_chain_that_comes_back_is_a_loop() {
        // A chain from the world, a tree, and two chains that each hang by themselves.
        assert!(!any(&[[None, Some(0)], [Some(0), Some(1)], [Some(2), Some(1)]]));
        assert!(!any(&[[Some(1), Some(0)], [Some(1), Some(2)], [Some(1), None]]));
        assert!(!any(&[[None, Some(0)], [None, Some(1)], [None, Some(2)]]));
        // Through bodies, through the background, and by two connectors between the same two.
        assert!(any(&[[Some(0), Some(1)], [Some(1), Some(2)], [Some(2), Some(0)]]));
        assert!(any(&[[None, Some(0)], [Some(0), Some(1)], [Some(1), None]]));
        assert!(any(&[[None, Some(2)], [Some(2), None]]));
        assert!(!any(&[]));
    }
}
