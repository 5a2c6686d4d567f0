//! Pairs that connectors, or other bodies, keep from being lifted: a wheel on a fixed axle that just touches its floor.
//! They keep the gap that they have, if they do not overlap.

use super::StartParts;
use super::correction::can_lift;
use halfgap_collision::{BodyId, Collision, Connector};

/// Which pairs keep their gaps.
#[derive(Clone, Debug, Default)]
pub(super) struct TightPairs {
    pairs: Vec<[BodyId; 2]>,
    /// Those that cannot be lifted one by one have been looked for.
    searched: bool,
}

impl TightPairs {
    /// True if the bodies of a record keep their gap.
    pub(super) fn keeps(&self, record: &Collision) -> bool {
        self.pairs.contains(&record.bodies())
    }

    /// Lets the pairs of some records that are too near keep their gaps: first such as cannot be lifted even
    /// alone, then all. Returns false if there are none that do not overlap.
    pub(super) fn widen(
        &mut self,
        bodies: &[StartParts],
        connectors: &[Connector],
        too_near: &[Collision],
    ) -> bool {
        let before = self.pairs.len();
        if !self.searched {
            self.searched = true;
            let stuck = too_near.iter().filter(|record| !can_lift(bodies, record, connectors));
            self.pairs.extend(stuck.map(Collision::bodies));
        }
        if self.pairs.len() == before {
            self.pairs.extend(too_near.iter().map(Collision::bodies));
        }
        self.pairs.len() > before
    }
}
