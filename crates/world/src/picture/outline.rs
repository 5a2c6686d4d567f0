//! The outline of a shape as SVG path data.

use super::svg::number;
use super::view::View;
use glam::DVec2;
use halfgap_geometry::{Arc, Edge, Pose, Shape};
use std::fmt::Write;

/// Returns the path data of a posed shape; drawn with the even-odd rule, holes stay open.
pub(super) fn path_data(shape: &Shape, pose: &Pose, view: &View) -> String {
    let mut data = String::new();
    for path in shape.paths() {
        let Some(first) = path.edges().first() else { continue };
        let start = view.to_page(pose.point_to_world(first.from()));
        let _ = write!(data, "M{} {}", number(start.0), number(start.1));
        for edge in path.edges() {
            match edge {
                Edge::Line(line) => {
                    let to = view.to_page(pose.point_to_world(line.to()));
                    let _ = write!(data, "L{} {}", number(to.0), number(to.1));
                }
                Edge::Arc(arc) => push_arc(&mut data, arc, pose, view),
            }
        }
        data.push('Z');
    }
    data
}

/// Draws an arc in two halves: neither then is more than a half circle, and a full circle has distinct end points.
fn push_arc(data: &mut String, arc: &Arc, pose: &Pose, view: &View) {
    let radius = number(arc.radius() * view.scale());
    // Counter-clockwise with y up is against SVG's positive angles, which turn clockwise on the page.
    let sweep = if arc.sweep_angle() > 0.0 { 0 } else { 1 };
    let middle_angle = arc.start_angle() + 0.5 * arc.sweep_angle();
    let middle = arc.center() + arc.radius() * DVec2::from_angle(middle_angle);
    for end in [middle, arc.to()] {
        let to = view.to_page(pose.point_to_world(end));
        let _ = write!(data, "A{radius} {radius} 0 0 {sweep} {} {}", number(to.0), number(to.1));
    }
}
