//! Pairs that connectors, or other bodies, keep from being lifted, such as a wheel on a fixed axle that just touches
//! its floor. They keep their given gap, if they do not overlap.

use super::correction::can_lift;
use crate::builder::Joints;
use halfgap_advance::rigid::BodyPart;
use halfgap_collision::{BodyId, Collision};

/// Pairs that keep their gaps.
#[derive(Clone, Debug, Default)]
pub(super) struct TightPairs {
    pairs: Vec<[BodyId; 2]>,
    /// Whether the pairs that cannot be lifted even alone have been looked for.
    searched: bool,
}

impl TightPairs {
    /// True if the bodies of a record keep their gap.
    pub(super) fn keeps(&self, record: &Collision) -> bool {
        self.pairs.contains(&record.bodies())
    }

    /// Lets pairs of the given records keep their gaps: at first those that cannot be lifted even alone, else all.
    /// Returns false if no pair was added.
    pub(super) fn widen(&mut self, bodies: &[BodyPart], connectors: &Joints, too_near: &[Collision]) -> bool {
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
