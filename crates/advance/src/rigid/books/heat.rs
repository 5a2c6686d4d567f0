//! The heat of each contact: what the ledger's `friction` is made of.
//!
//! A contact has an account from the first heat that it makes until it ends. One that has ended keeps its account until the next event, so
//! that whoever is told of its end is told its heat, too.

use crate::rigid::books::report::{ContactChanges, RowForce};
use crate::rigid::contacts::rows::{ActiveRow, RowSource};
use halfgap_collision::BodyId;
use halfgap_geometry::FeatureId;

/// The primary and the normal body of a contact, and their features.
type Key = ([BodyId; 2], [FeatureId; 2]);

/// Heat [J] of each contact that goes on and has made any.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Heat {
    /// Sorted by contact.
    accounts: Vec<(Key, f64)>,
}

impl Heat {
    /// Adds the work [J] of friction at a contact's row, which is negative.
    pub(super) fn book(&mut self, row: &ActiveRow, work: f64) {
        let RowSource::Contact(features) = row.source else { return };
        let key = (row.bodies, features);
        match self.place(key) {
            Ok(place) => self.accounts[place].1 -= work,
            Err(place) => self.accounts.insert(place, (key, 0.0 - work)),
        }
    }

    /// Heat [J] that a contact has made until the present segments; `None` of other rows, and of contacts without friction.
    pub(super) fn told(&self, row: &RowForce) -> Option<f64> {
        let features = row.features?;
        (row.friction.is_some() || row.rolling.is_some()).then(|| {
            let place = self.place((row.bodies, features)).ok();
            place.map_or(0.0, |place| self.accounts[place].1)
        })
    }

    /// Tells the heat of all contacts that change.
    pub(super) fn tell(&self, changes: &mut ContactChanges) {
        let ContactChanges { begin, end, turn, undecided, .. } = changes;
        for row in begin.iter_mut().chain(end).chain(turn).chain(undecided) {
            row.heat = self.told(row);
        }
    }

    /// Closes the accounts of contacts that have ended.
    pub(super) fn close(&mut self, ended: &[RowForce]) {
        if self.accounts.is_empty() {
            return;
        }
        for row in ended {
            let place = row.features.map(|features| self.place((row.bodies, features)));
            if let Some(Ok(place)) = place {
                self.accounts.remove(place);
            }
        }
    }

    fn place(&self, key: Key) -> Result<usize, usize> {
        self.accounts.binary_search_by_key(&key, |&(key, _)| key)
    }
}
