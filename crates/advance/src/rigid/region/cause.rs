//! The cause of an event.

use crate::rigid::contacts::friction::Axis;
use crate::rigid::contacts::touch::Touch;
use halfgap_collision::ConnectorId;

/// Cause of an event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Cause {
    /// The start: contacts at rest within `distance_tol` count as touching.
    Start,
    /// A contact fires: it takes part, however near it is to the ends of its features.
    Fired(Touch),
    /// A rope goes taut, or the point of a rail comes to its stop.
    Taut(ConnectorId),
    /// A contact has run off its features: its neighbours take over, if they touch.
    RunOff(Touch),
    /// A contact has lost its force: a small force found on it now may come from the motion of other bodies meanwhile.
    Released(Touch),
    /// The slip of a contact along an axis has come to a stop.
    Stopped(Touch, Axis),
    /// A joint with dry friction has come to rest, or one with a motor to its speed; true if its rate was above that before.
    Rests(ConnectorId, bool),
    /// The steps of a group have become endlessly short while its contacts slip: their forces grow beyond all bounds.
    Collapsed,
    /// Sunk contacts are put back, where contacts carry impulses only.
    Tick,
    /// The point of a rail goes over a smooth joint: velocities stopped by its connectors are rounding, not an impact.
    SmoothJoint,
    /// Any other cause: a corner of a rail, a force law, an intervention of the caller.
    #[default]
    Other,
}

impl Cause {
    /// The contact that fired, if one did.
    pub(crate) fn fired(self) -> Option<Touch> {
        if let Self::Fired(touch) = self { Some(touch) } else { None }
    }

    /// The contact that has run off its features, if one has.
    pub(crate) fn run_off(self) -> Option<Touch> {
        if let Self::RunOff(touch) = self { Some(touch) } else { None }
    }
}
