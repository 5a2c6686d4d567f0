//! Bodies that a pin and a drive of its angle hold to what cannot move: their motion is known beforehand, and the forces of their rows
//! follow from it (`ActiveRows`).
//!
//! *Invariant*: on a held body no row acts beside these but those of contacts. Other joints could depend on them, and would share their
//! forces.

use crate::rigid::contacts::rows::RowSource;
use crate::rigid::group::state::Group;
use halfgap_collision::Connector;
use halfgap_contact::HeldBody;

impl Group {
    /// The held bodies; the sides of rows must be known.
    pub(super) fn held(&self, connectors: &[Connector]) -> impl Iterator<Item = HeldBody> {
        self.driven.iter().filter_map(|&drive| self.held_by(drive, connectors))
    }

    /// The body that a driven row holds together with a pin.
    fn held_by(&self, drive: usize, connectors: &[Connector]) -> Option<HeldBody> {
        let connector = |row: usize| match self.rows[row].source {
            RowSource::Connector(id, _) => Some(&connectors[id.index()]),
            RowSource::Contact(_) | RowSource::Anchor(_) | RowSource::Pull(_) => None,
        };
        let ([Some(body), None] | [None, Some(body)]) = self.sides[drive] else { return None };
        let is_angle = connector(drive)?.anchors() == [None; 2];
        let on_body = |row: &usize| self.sides[*row].contains(&Some(body));
        let is_joint = |row: &usize| on_body(row) && connector(*row).is_some();
        let mut pin = (0..self.rows.len()).filter(is_joint).filter(|&row| row != drive);
        let [x, y] = [pin.next()?, pin.next()?];
        let is_pin = connector(x)?.is_pin() && self.sides[x].contains(&None) && y == x + 1;
        let is_alone = pin.next().is_none() && self.thirds.iter().all(|third| third.body != body);
        let place = |row: usize| u32::try_from(row).ok();
        (is_angle && is_pin && is_alone)
            .then_some(HeldBody { body, rows: [place(x)?, place(y)?, place(drive)?] })
    }
}
