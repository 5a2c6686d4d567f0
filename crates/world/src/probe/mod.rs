//! Probes: quantities that are read from a recording, each under a name.
//!
//! A probe reads what was recorded, and changes nothing. `table` has the values of all probes at all output times.

mod of_scene;
mod table;

pub use table::ProbeTable;

use crate::recording::{Frame, Recording};
use crate::world::World;
use glam::DVec2;
use halfgap_collision::{Anchor, BodyId, Connector, ConnectorId, Coordinate, Moving};

/// A quantity to be read from a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name under which it is told.
    pub name: String,
    /// What it measures.
    pub kind: ProbeKind,
}

/// What a probe measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProbeKind {
    /// Position [m] and velocity [m/s] of a point.
    Point(Anchor),
    /// Angle of the second body less that of the first [rad], whole turns counted, and its rate [rad/s].
    Angle([BodyId; 2]),
    /// Distance of two points [m], and its rate [m/s].
    Distance([Anchor; 2]),
    /// Force [N] and torque [N m] of a connector and all that acts on its free coordinate on its body a (of a rack the bar), the torque about the
    /// connector's point of a, and the free coordinate: of a pin the angle of b less that of a [rad], of a slider the displacement of b along the
    /// axis, of a slot that along its normal turned by -90 degrees [m].
    Connector(ConnectorId),
    /// Sum of the contact forces of the second body on the first [N], friction included.
    Contact([BodyId; 2]),
}

/// A quantity of a probe: its name and its unit.
pub type Quantity = (&'static str, &'static str);

impl Probe {
    /// The quantities that it measures, in their order.
    #[must_use]
    pub fn quantities(&self, world: &World) -> Vec<Quantity> {
        match &self.kind {
            ProbeKind::Point(_) => vec![("x", "m"), ("y", "m"), ("vx", "m/s"), ("vy", "m/s")],
            ProbeKind::Angle(_) => vec![("angle", "rad"), ("rate", "rad/s")],
            ProbeKind::Distance(_) => vec![("distance", "m"), ("rate", "m/s")],
            ProbeKind::Connector(id) => {
                let mut quantities = vec![("fx", "N"), ("fy", "N"), ("torque", "N m")];
                match world.connectors()[id.index()].coordinate() {
                    Some(Coordinate::Angle { .. }) => {
                        quantities.extend([("angle", "rad"), ("rate", "rad/s")])
                    }
                    Some(Coordinate::Along { .. }) => {
                        quantities.extend([("coordinate", "m"), ("rate", "m/s")]);
                    }
                    None => (),
                }
                quantities
            }
            ProbeKind::Contact(_) => vec![("fx", "N"), ("fy", "N")],
        }
    }

    /// Adds the values of its quantities in a frame of a recording of the world to a list.
    pub(crate) fn measure(&self, world: &World, recording: &Recording, frame: &Frame, values: &mut Vec<f64>) {
        let moving = |body| moving_in(world, recording, frame, body);
        match &self.kind {
            ProbeKind::Point(anchor) => {
                let (position, velocity) = place(anchor, &moving(anchor.body));
                values.extend([position.x, position.y, velocity.x, velocity.y]);
            }
            ProbeKind::Angle(bodies) => values.extend(turn(bodies.map(moving))),
            ProbeKind::Distance(ends) => {
                let [a, b] = ends.map(|end| place(&end, &moving(end.body)));
                let (offset, rate) = (a.0 - b.0, a.1 - b.1);
                values.extend([offset.length(), offset.normalize_or_zero().dot(rate)]);
            }
            ProbeKind::Connector(id) => {
                let connector = &world.connectors()[id.index()];
                let point = match connector.anchors() {
                    [Some(a), _] => place(a, &moving(a.body)).0,
                    [None, _] => DVec2::ZERO,
                };
                let (mut force, mut torque) = (DVec2::ZERO, 0.0);
                for row in frame.forces.iter().filter(|row| row.connector == Some(*id)) {
                    force += row.force * row.normal;
                    let arm = row.point.map_or(DVec2::ZERO, |at| at - point);
                    torque += arm.perp_dot(row.force * row.normal) + row.torque.unwrap_or(0.0);
                }
                values.extend([force.x, force.y, torque]);
                values.extend(coordinate(connector, connector.bodies().map(moving)).into_iter().flatten());
            }
            ProbeKind::Contact([a, b]) => {
                let contacts = frame.forces.iter().filter(|row| row.connector.is_none());
                let sum = contacts.fold(DVec2::ZERO, |sum, row| {
                    let along = row.friction.map_or(0.0, |friction| friction.force);
                    let force = row.force * row.normal + along * row.normal.perp();
                    match row.bodies {
                        [first, second] if [first, second] == [*a, *b] => sum + force,
                        [first, second] if [second, first] == [*a, *b] => sum - force,
                        _ => sum,
                    }
                });
                values.extend([sum.x, sum.y]);
            }
        }
    }
}

/// The motion of a body in a frame.
fn moving_in(world: &World, recording: &Recording, frame: &Frame, body: BodyId) -> Moving {
    if body.is_world() {
        return Moving::BACKGROUND;
    }
    let recorded = recording.place(body).and_then(|place| frame.states.get(place));
    Moving::from(&recorded.copied().unwrap_or_else(|| world.state(body)))
}

/// Position [m] and velocity [m/s] of an anchor.
fn place(anchor: &Anchor, moving: &Moving) -> (DVec2, DVec2) {
    let arm = moving.pose.vector_to_world(anchor.point);
    (moving.pose.position + arm, moving.velocity_at(arm))
}

/// Angle of the second body less that of the first, and its rate.
fn turn([a, b]: [Moving; 2]) -> [f64; 2] {
    [b.angle - a.angle, b.angular_velocity - a.angular_velocity]
}

/// Free coordinate of a connector and its rate; `None` if it has none.
fn coordinate(connector: &Connector, [a, b]: [Moving; 2]) -> Option<[f64; 2]> {
    let row = connector.coordinate()?.measure([&a, &b]);
    Some([row.gap, row.kinematics.rate])
}
