//! Forces as arrows, from the point of each force, for every movable body that it acts on.

use super::svg::{Svg, TextStyle, number};
use super::ticks::{label, round_step};
use super::view::View;
use crate::event::ContactForce;
use crate::recording::{Frame, Recording};
use glam::DVec2;

const COLOR: &str = "#c4262e";
/// Length of the arrow of the greatest force of a recording [px].
const LONGEST: f64 = 90.0;
/// Length of the shortest arrow that is drawn [px].
const SHORTEST: f64 = 1.5;
/// Length and half-width of an arrow's head [px].
const HEAD: (f64, f64) = (9.0, 3.5);
/// Largest length of an arrow's head, as a fraction of the arrow.
const HEAD_SHARE: f64 = 0.6;

/// A force on the first of two bodies at a point; the other gets the opposite.
#[derive(Clone, Copy, Debug)]
struct Push {
    contact: ContactForce,
    force: DVec2,
}

/// Scale of the arrows.
#[derive(Clone, Copy, Debug)]
pub(super) struct ForceScale {
    pixels_per_newton: f64,
}

impl ForceScale {
    /// Returns the scale that all pictures of a recording share; `None` if it has no forces.
    pub(super) fn of(recording: &Recording) -> Option<Self> {
        let sizes = recording.frames.iter().flat_map(pushes).map(|push| push.force.length());
        let greatest = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
        let pixels_per_newton = LONGEST / greatest;
        (greatest > 0.0 && pixels_per_newton.is_finite()).then_some(Self { pixels_per_newton })
    }

    /// Draws the forces of a frame.
    pub(super) fn draw(self, svg: &mut Svg, recording: &Recording, frame: &Frame, view: &View) {
        svg.open_group(&[("stroke", COLOR), ("stroke-width", "1.6"), ("fill", COLOR)]);
        for push in pushes(frame) {
            let [primary, normal] = push.contact.bodies;
            for (body, force) in [(primary, push.force), (normal, -push.force)] {
                if recording.place(body).is_some() {
                    self.draw_arrow(svg, view.to_page(push.contact.point), force);
                }
            }
        }
        svg.close_group();
    }

    /// Draws a key, an arrow of a round force, with its right end at a point of the page.
    pub(super) fn draw_key(self, svg: &mut Svg, (right, y): (f64, f64)) {
        let force = round_step(LONGEST / self.pixels_per_newton, 1.5);
        let text = format!("{} N", label(force, force));
        let length = force * self.pixels_per_newton;
        svg.open_group(&[("stroke", COLOR), ("stroke-width", "1.6"), ("fill", COLOR)]);
        self.draw_arrow(svg, (right - length, y), DVec2::new(force, 0.0));
        svg.close_group();
        let style = TextStyle { size: 12.0, anchor: "end", color: "#6b7278" };
        svg.text((right - length - 8.0, y + 4.0), style, &text);
    }

    fn draw_arrow(self, svg: &mut Svg, from: (f64, f64), force: DVec2) {
        // The page's y axis points down.
        let along = DVec2::new(force.x, -force.y) * self.pixels_per_newton;
        let length = along.length();
        if !(SHORTEST..=2.0 * LONGEST).contains(&length) {
            return;
        }
        let (head, half_width) = HEAD;
        let size = (HEAD_SHARE * length / head).min(1.0);
        let direction = along / length;
        let tip = DVec2::new(from.0, from.1) + along;
        let neck = tip - direction * (head * size);
        let wing = direction.perp() * (half_width * size);
        svg.line(from, (neck.x, neck.y), &[]);
        let corner = |point: DVec2| format!("{} {}", number(point.x), number(point.y));
        let data = format!("M{}L{}L{}Z", corner(tip), corner(neck + wing), corner(neck - wing));
        svg.path(&data, &[("stroke", "none")]);
    }
}

/// Returns the forces of a frame; the rows of one connector are one force.
fn pushes(frame: &Frame) -> Vec<Push> {
    let mut pushes: Vec<Push> = Vec::new();
    for contact in &frame.forces {
        let force = contact.force * contact.normal;
        let same = |push: &&mut Push| {
            contact.connector.is_some()
                && push.contact.connector == contact.connector
                && push.contact.bodies == contact.bodies
        };
        // The rows of a connector follow each other.
        match pushes.last_mut().filter(same) {
            Some(push) => push.force += force,
            None => pushes.push(Push { contact: *contact, force }),
        }
    }
    pushes
}
