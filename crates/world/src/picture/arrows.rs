//! Forces as arrows, from the point of each force, for every movable body that it acts on.

use super::svg::{Svg, TextStyle, number};
use super::ticks::RoundStep;
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
/// Radius of the mark of a contact with friction [px].
const DOT: f64 = 2.6;
/// Largest length of an arrow's head, as a fraction of the arrow.
const HEAD_SHARE: f64 = 0.6;

/// A force on the first of two bodies at a point; the other gets the opposite.
#[derive(Clone, Copy, Debug)]
struct Push {
    contact: ContactForce,
    force: DVec2,
}

/// An arrow that is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrow {
    /// The point of the world from which it goes [m].
    pub(super) from: DVec2,
    /// Its vector on the page [px], y up.
    pub(super) along: DVec2,
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
        for arrow in self.arrows(recording, frame) {
            draw_arrow(svg, view.to_page(arrow.from), arrow.along);
        }
        // Contacts that stick are dots, those that slip are rings.
        for contact in &frame.forces {
            let Some(friction) = contact.friction else { continue };
            let fill = if friction.sticks { COLOR } else { "#ffffff" };
            let Some(point) = contact.point else { continue };
            svg.circle(view.to_page(point), DOT, &[("fill", fill)]);
        }
        svg.close_group();
    }

    /// Returns the arrows that are drawn for a frame.
    pub(super) fn arrows(self, recording: &Recording, frame: &Frame) -> impl Iterator<Item = Arrow> {
        let arrows = pushes(frame).into_iter().flat_map(move |push| {
            let [primary, normal] = push.contact.bodies;
            [(primary, push.force), (normal, -push.force)].map(|(body, force)| {
                let from = push.contact.point?;
                let arrow = Arrow { from, along: force * self.pixels_per_newton };
                let drawn = (SHORTEST..=2.0 * LONGEST).contains(&arrow.along.length());
                (drawn && recording.place(body).is_some()).then_some(arrow)
            })
        });
        arrows.flatten()
    }

    /// Draws a key, an arrow of a round force, with its right end at a point of the page.
    pub(super) fn draw_key(self, svg: &mut Svg, (right, y): (f64, f64)) {
        let force = RoundStep::of(LONGEST / self.pixels_per_newton, 1.5);
        let text = format!("{} N", force.label());
        let length = force.size() * self.pixels_per_newton;
        svg.open_group(&[("stroke", COLOR), ("stroke-width", "1.6"), ("fill", COLOR)]);
        draw_arrow(svg, (right - length, y), DVec2::new(length, 0.0));
        svg.close_group();
        let style = TextStyle { size: 12.0, anchor: "end", color: "#6b7278" };
        svg.text((right - length - 8.0, y + 4.0), style, &text);
    }
}

/// Draws an arrow from a point of the page [px] along a vector [px, y up].
fn draw_arrow(svg: &mut Svg, from: (f64, f64), along: DVec2) {
    // The page's y axis points down.
    let along = DVec2::new(along.x, -along.y);
    let length = along.length();
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

/// Returns the forces of a frame; the rows of one connector are one force.
fn pushes(frame: &Frame) -> Vec<Push> {
    let mut pushes: Vec<Push> = Vec::new();
    for contact in frame.forces.iter().filter(|contact| contact.point.is_some()) {
        let friction = contact.friction.map_or(0.0, |friction| friction.force);
        let force = contact.force * contact.normal + friction * contact.normal.perp();
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
