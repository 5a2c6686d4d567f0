//! Connectors: rails as the curves that they are, rods and ropes as lines between their points, pins and slots as small rings.

use super::svg::{Svg, number};
use super::view::View;
use crate::recording::{Frame, Recording};
use crate::world::World;
use glam::DVec2;
use halfgap_collision::{Anchor, Connector, ConnectorKind, RailPath};
use halfgap_geometry::Aabb;
use std::fmt::Write;

/// A rail is drawn through so many points, and its joints.
const RAIL_POINTS: usize = 256;
/// Radius of the ring of a pin or a slot [px].
const RING: f64 = 3.5;
const COLOR: &str = "#4c5459";

/// The boxes of what connectors tie to the world: rails, and points of the background.
pub(super) fn fixed_boxes(world: &World) -> impl Iterator<Item = Aabb> + '_ {
    world.connectors().iter().flat_map(|connector| {
        let (a, b) = connector.anchors();
        let fixed = [Some(a), b].into_iter().flatten().filter(|anchor| anchor.body.is_world());
        let points = fixed.map(|anchor| Aabb::around(anchor.point));
        points.chain(connector.path().map(|path| path.bounds()))
    })
}

/// Draws the rails of a world.
pub(super) fn draw_rails(svg: &mut Svg, world: &World, view: &View) {
    for connector in world.connectors() {
        if let ConnectorKind::Rail { path, .. } = &connector.kind {
            let attributes = [("fill", "none"), ("stroke", COLOR), ("stroke-width", "1.5")];
            svg.path(&rail_data(path, view), &attributes);
        }
    }
}

fn rail_data(path: &RailPath, view: &View) -> String {
    let even = (0..=RAIL_POINTS).map(|part| path.length() * part as f64 / RAIL_POINTS as f64);
    let mut lengths: Vec<f64> = even.chain(path.knots().iter().map(|knot| knot.arc_length)).collect();
    lengths.sort_unstable_by(f64::total_cmp);
    lengths.dedup();
    let mut data = String::new();
    for length in lengths {
        let (x, y) = view.to_page(path.place_at(length).point());
        let _ = write!(data, "{}{} {}", if data.is_empty() { 'M' } else { 'L' }, number(x), number(y));
    }
    data
}

/// Draws what ties bodies in a frame of a recording: ropes with dashes, rods without.
pub(super) fn draw_ties(svg: &mut Svg, world: &World, recording: &Recording, frame: &Frame, view: &View) {
    for connector in world.connectors() {
        let [a, b] = ends(world, recording, frame, connector).map(|end| end.map(|end| view.to_page(end)));
        let line = [("stroke", COLOR), ("stroke-width", "1.5"), ("stroke-dasharray", "6 3")];
        let ring = [("fill", "none"), ("stroke", COLOR), ("stroke-width", "1.5")];
        match (&connector.kind, a, b) {
            (ConnectorKind::Rod { .. }, Some(a), Some(b)) => svg.line(a, b, &line[..2]),
            (ConnectorKind::Rope { .. }, Some(a), Some(b)) => svg.line(a, b, &line),
            (ConnectorKind::Pin { .. } | ConnectorKind::Slot { .. }, Some(a), _) => {
                svg.circle(a, RING, &ring);
            }
            _ => {}
        }
    }
}

/// Where the points of a connector are in a frame.
fn ends(world: &World, recording: &Recording, frame: &Frame, connector: &Connector) -> [Option<DVec2>; 2] {
    let place_of = |anchor: &Anchor| {
        if anchor.body.is_world() {
            return anchor.point;
        }
        let place = recording.movable.iter().position(|&body| body == anchor.body);
        let state = place.and_then(|place| frame.states.get(place).copied());
        state.unwrap_or_else(|| world.state(anchor.body)).pose().point_to_world(anchor.point)
    };
    let (a, b) = connector.anchors();
    [Some(place_of(a)), b.map(place_of)]
}
