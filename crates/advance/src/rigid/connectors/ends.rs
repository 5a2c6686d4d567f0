//! The ends of the piece of a rail on which a point is.

use glam::DVec2;
use halfgap_collision::{RailHint, RailKnot, RailPath, RailPlace};

/// The joint at an end of a rail's piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RailEnd<'a> {
    pub(crate) knot: &'a RailKnot,
    /// True for the end at which the piece is left forward.
    pub(crate) is_forward: bool,
    /// Distance [m] along the rail from a place to the joint; negative beyond it.
    pub(crate) room: f64,
}

/// The ends of the piece of a rail's place, forward and backward; `None` where the rail goes on without end.
pub(crate) fn end_rooms<'a>(path: &'a RailPath, place: &RailPlace) -> [Option<RailEnd<'a>>; 2] {
    [true, false].map(|is_forward| {
        let knot = path.knot_at_end(place.piece(), is_forward)?;
        // On a closed path the joint at its start is at both of its ends.
        let wraps = is_forward && path.is_closed() && knot.arc_length == 0.0;
        let end = if wraps { path.length() } else { knot.arc_length };
        let room = if is_forward { end - place.arc_length } else { place.arc_length - end };
        Some(RailEnd { knot, is_forward, room })
    })
}

/// Distance [m] along a rail to the nearer end of the piece on which a point is. If both ends have a joint, the product
/// of the two distances over their sum: it is smooth where they are equal, and under a steady acceleration a quartic in
/// time.
pub(crate) fn rail_room(path: &RailPath, point: DVec2, hint: Option<&RailHint>) -> Option<f64> {
    let place = path.nearest(point, hint);
    let rooms = end_rooms(path, &place).into_iter().flatten().map(|end| end.room);
    rooms.reduce(|room, other| room * other / (room + other))
}
