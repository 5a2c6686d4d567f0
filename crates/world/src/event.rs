//! What a world tells of an impact.

use glam::DVec2;
use halfgap_collision::{BodyId, BodyState};

/// One place at which two bodies collided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactRow {
    /// The body that the normal points to.
    pub primary: BodyId,
    /// The body that the normal points out of.
    pub normal_body: BodyId,
    /// Where [m].
    pub point: DVec2,
    /// Unit normal, from the normal body to the primary one.
    pub normal: DVec2,
    /// Gap [m].
    pub gap: f64,
    /// Rate of the gap before [m/s], negative when closing.
    pub velocity_before: f64,
    /// Rate of the gap after [m/s].
    pub velocity_after: f64,
    /// Impulse on the primary body along the normal [N s]; the other body gets the opposite.
    pub impulse: f64,
}

/// An impact: everything that collided at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Impact {
    /// When [s].
    pub time: f64,
    /// Where, and how hard.
    pub rows: Vec<ImpactRow>,
    /// Change of the kinetic energy [J].
    pub energy_change: f64,
    /// States of the movable bodies that took part, after the impact.
    pub states: Vec<(BodyId, BodyState)>,
}
