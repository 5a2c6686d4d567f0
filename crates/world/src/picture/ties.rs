//! Connectors and springs: rails as curves, their stops as bars across, rods and ropes as lines between their points,
//! pins as small rings, slots and sliders as small rings on a line along which they slide, welds as crosses, springs and dashpots as zigzags.

use super::svg::{Svg, number};
use super::view::View;
use crate::recording::{Frame, Recording};
use crate::world::World;
use glam::DVec2;
use halfgap_collision::{Anchor, BodyId, Connector, ConnectorKind, Coordinate, RailPath, SlotFrame};
use halfgap_geometry::Aabb;
use std::fmt::Write;

/// Number of evenly spaced pieces of a drawn rail, besides its knots.
const RAIL_POINTS: usize = 256;
/// Radius of the ring of a pin or a slot [px].
const RING: f64 = 3.5;
/// Length of the line of a slot to either side of its ring [px].
const SLOT: f64 = 12.0;
const COLOR: &str = "#4c5459";

/// Number of teeth of the zigzag of a spring.
const TEETH: usize = 8;
/// Height of a tooth of the zigzag [px].
const TOOTH: f64 = 5.0;
/// Straight part at each end of the zigzag, as a fraction of its length.
const STRAIGHT: f64 = 0.15;
/// Length of the bar of a stop to either side of its rail [px].
const BAR: f64 = 7.0;
const LINE: [(&str, &str); 3] = [("fill", "none"), ("stroke", COLOR), ("stroke-width", "1.5")];

/// Returns the boxes of rails.
pub(super) fn rail_boxes(world: &World) -> impl Iterator<Item = Aabb> + '_ {
    world.connectors().iter().filter_map(|connector| Some(connector.path()?.bounds()))
}

/// Returns the points that connectors and springs tie.
pub(super) fn tied_points(world: &World) -> impl Iterator<Item = Anchor> + '_ {
    let of_connectors = world.connectors().iter().flat_map(Connector::anchors);
    of_connectors.flatten().copied().chain(elastic_ties(world).flatten())
}

/// Returns the ends of springs and dashpots, once for laws that follow each other with the same ends.
fn elastic_ties(world: &World) -> impl Iterator<Item = [Anchor; 2]> + '_ {
    let mut last = None;
    let ends = world.forces().filter_map(|law| law.ends());
    ends.filter(move |&ends| last.replace(ends) != Some(ends))
}

/// Draws the rails of a world with their stops.
pub(super) fn draw_rails(svg: &mut Svg, world: &World, view: &View) {
    for connector in world.connectors() {
        match &connector.kind {
            ConnectorKind::Rail { path, .. } => svg.path(&rail_data(path, view), &LINE),
            ConnectorKind::RailStop { path, at, .. } => {
                let place = path.place_at(*at);
                let across = place.normal() * (BAR / view.scale());
                let [a, b] = [place.point() - across, place.point() + across];
                svg.line(view.to_page(a), view.to_page(b), &LINE[1..]);
            }
            _ => {}
        }
    }
}

fn rail_data(path: &RailPath, view: &View) -> String {
    let even = (0..=RAIL_POINTS).map(|part| path.length() * part as f64 / RAIL_POINTS as f64);
    let mut lengths: Vec<f64> = even.chain(path.knots().iter().map(|knot| knot.arc_length)).collect();
    lengths.sort_unstable_by(f64::total_cmp);
    lengths.dedup();
    polyline(lengths.into_iter().map(|length| view.to_page(path.place_at(length).point())))
}

/// Returns the path data of a polyline through points of the page.
fn polyline(points: impl Iterator<Item = (f64, f64)>) -> String {
    let mut data = String::new();
    for (x, y) in points {
        let command = if data.is_empty() { 'M' } else { 'L' };
        let _ = write!(data, "{command}{} {}", number(x), number(y));
    }
    data
}

/// Draws the connectors and springs in a frame of a recording, but for rails and stops: ropes with dashes, rods
/// without.
pub(super) fn draw_ties(svg: &mut Svg, world: &World, recording: &Recording, frame: &Frame, view: &View) {
    let place_of = |anchor: &Anchor| view.to_page(place_of(world, recording, Some(frame), anchor));
    for connector in world.connectors() {
        let [a, b] = connector.anchors().map(|end| end.map(place_of));
        match (&connector.kind, a, b) {
            (ConnectorKind::Rod { .. }, Some(a), Some(b)) => svg.line(a, b, &LINE[1..]),
            (ConnectorKind::Rope { .. }, Some(a), Some(b)) => {
                svg.line(a, b, &[LINE[1], LINE[2], ("stroke-dasharray", "6 3")]);
            }
            (ConnectorKind::Pin { .. }, Some(a), _) => svg.circle(a, RING, &LINE),
            (ConnectorKind::Weld { .. }, Some((x, y)), _) => {
                for tilt in [-RING, RING] {
                    svg.line((x - RING, y - tilt), (x + RING, y + tilt), &LINE[1..]);
                }
            }
            (ConnectorKind::Pulley { wheels, .. }, Some(a), Some(b)) => {
                let [first, last] = wheels.map(|wheel| view.to_page(wheel));
                let path = polyline([a, first, last, b].into_iter());
                svg.path(&path, &[LINE[0], LINE[1], LINE[2], ("stroke-dasharray", "6 3")]);
            }
            (ConnectorKind::Slot { .. } | ConnectorKind::Slider { .. }, Some(a), _) => {
                let Some(Coordinate::Along { a: on_a, b: on_b, axis, frame }) = connector.coordinate() else {
                    continue;
                };
                let direction = slot_direction([&on_a, &on_b], -axis, frame);
                let [from, to] = direction.map(|anchor| DVec2::from(place_of(&anchor)));
                let along = (to - from).normalize_or_zero() * SLOT;
                let [from, to] = [-along, along].map(|way| (a.0 + way.x, a.1 + way.y));
                svg.line(from, to, &LINE[1..]);
                svg.circle(a, RING, &LINE);
            }
            _ => {}
        }
    }
    for ends in elastic_ties(world) {
        svg.path(&zigzag(ends.each_ref().map(place_of)), &LINE);
    }
}

/// Returns the path data of a spring between two points of the page.
fn zigzag([a, b]: [(f64, f64); 2]) -> String {
    let [a, b] = [a, b].map(DVec2::from);
    let across = (b - a).normalize_or_zero().perp() * TOOTH;
    let tooth = |at: usize| {
        let part = STRAIGHT + (1.0 - 2.0 * STRAIGHT) * (at as f64 + 0.5) / TEETH as f64;
        a.lerp(b, part) + if at.is_multiple_of(2) { across } else { -across }
    };
    let [first, last] = [STRAIGHT, 1.0 - STRAIGHT].map(|part| a.lerp(b, part));
    let points = [a, first].into_iter().chain((0..TEETH).map(tooth)).chain([last, b]);
    polyline(points.map(|point| (point.x, point.y)))
}

/// Returns two points along the direction in which a slot slides, on the body that carries it.
fn slot_direction([a, b]: [&Anchor; 2], axis: DVec2, frame: SlotFrame) -> [Anchor; 2] {
    let carrier = match frame {
        SlotFrame::A => *a,
        SlotFrame::B => *b,
        SlotFrame::World => Anchor { body: BodyId::WORLD, point: DVec2::ZERO },
    };
    [carrier, Anchor { point: carrier.point + axis, ..carrier }]
}

/// Returns the world position of an anchor in a frame [m]; without a frame, at the present state of the world.
pub(super) fn place_of(
    world: &World,
    recording: &Recording,
    frame: Option<&Frame>,
    anchor: &Anchor,
) -> DVec2 {
    if anchor.body.is_world() {
        return anchor.point;
    }
    let recorded = recording.place(anchor.body).zip(frame);
    let state = recorded.and_then(|(place, frame)| frame.states.get(place).copied());
    state.unwrap_or_else(|| world.state(anchor.body)).pose().point_to_world(anchor.point)
}
