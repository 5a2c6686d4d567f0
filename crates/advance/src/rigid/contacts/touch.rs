//! Two features that touch, one of each of two bodies.

use halfgap_collision::{BodyId, Collision};
use halfgap_geometry::FeatureId;

/// A pair of features that touches, the lesser body first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Touch {
    pub(crate) bodies: [BodyId; 2],
    pub(crate) features: [FeatureId; 2],
}

impl Touch {
    /// The features of a record, unless it is a connector's.
    pub(crate) fn of(record: &Collision) -> Option<Touch> {
        let (primary, normal) = (&record.parties.primary, &record.parties.normal);
        Some(Touch::new([primary.body, normal.body], [primary.feature()?, normal.feature()?]))
    }

    /// The features of a contact, whichever of its two bodies is named first.
    pub(crate) fn new(bodies: [BodyId; 2], features: [FeatureId; 2]) -> Self {
        if bodies[0] <= bodies[1] {
            Self { bodies, features }
        } else {
            Self { bodies: [bodies[1], bodies[0]], features: [features[1], features[0]] }
        }
    }
}

/// Two bodies, the lesser first.
pub(crate) fn sorted(a: BodyId, b: BodyId) -> [BodyId; 2] {
    if a <= b { [a, b] } else { [b, a] }
}

pub(crate) fn touch_of(record: &Collision, bodies: [BodyId; 2]) -> Option<Touch> {
    Touch::of(record).filter(|touch| touch.bodies == bodies)
}

/// Largest penetration of an active contact whose zone cannot be seen, as a multiple of the target gap: a deeper one is
/// lifted to it.
pub(crate) const DEEPEST: f64 = 0.5;
