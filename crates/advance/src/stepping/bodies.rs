//! The bodies of a system that is advanced by steps: their places at the start of the present step, the velocities with which
//! they go through it, and what can be read in between.
//!
//! *Invariant*: a body goes straight from the start of a step to its end, with the velocity in its middle; what is read in
//! between is the parabola that has this velocity there and the acceleration of the step.

use crate::rigid::{BodyPart, FreeMotion, Surface};
use crate::stepping::rows::Mover;
use glam::DVec2;
use halfgap_collision::{Body, BodyId, BodyState, Motion, MovedPath, Moving};
use halfgap_contact::InverseInertia;

/// What does not change about a body.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Nature {
    pub(super) body: Body,
    pub(super) free_motion: FreeMotion,
    pub(super) surface: Surface,
    /// Largest distance [m] of a point from the centre of mass.
    pub(super) reach: f64,
    pub(super) is_convex: bool,
    /// Least width [m], about: of a plate that of a block of the same area and length.
    pub(super) thickness: f64,
    /// Prescribed motion from a time [s] on of a fixed body that is moved otherwise than at constant velocities.
    moved: Option<(MovedPath, f64)>,
}

/// Velocities, accelerations or displacements of x, y and angle.
pub(super) type Motion3 = [f64; 3];

/// The motion of a body through the present step.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Course {
    /// Place at the start of the step.
    pub(super) position: DVec2,
    pub(super) angle: f64,
    /// Velocity in the middle of the step, with which the body goes from its start to its end.
    pub(super) middle: Motion3,
    /// Velocity in the middle of the step without what slows down bodies that are to hit each other at its end.
    pub(super) smooth: Motion3,
    /// Acceleration of the step.
    pub(super) acceleration: Motion3,
    /// The part of it that is due to contacts and connectors.
    pub(super) pushed: Motion3,
    /// What these make of the velocity in a step, be it all at once or not.
    pub(super) push: Motion3,
    /// Bound on what this has changed by since the step before [m/s].
    pub(super) jump: f64,
    /// Bound on what connectors make of the velocity in a step [m/s].
    pub(super) led: f64,
    /// Share of the step that it does not go [-]: it stops where it would pass through something, and its own time stands still.
    pub(super) delay: f64,
}

impl Course {
    /// Stays where it is.
    pub(super) fn stop(&mut self) {
        let Self { position, angle, .. } = *self;
        *self = Self { position, angle, ..Self::default() };
    }

    /// Place at a time `since` [s] the start of a step of a length `span` [s].
    pub(super) fn place_at(&self, since: f64, span: f64) -> Motion3 {
        let BodyState { position, angle, .. } = self.state_at(since, span);
        [position.x, position.y, angle]
    }

    /// State at a time `since` [s] the start of a step of a length `span` [s].
    #[inline]
    pub(super) fn state_at(&self, since: f64, span: f64) -> BodyState {
        let ([x, y, spin], [u, v, turn]) = (self.middle, self.smooth);
        let [ax, ay, turning] = self.acceleration;
        let bend = if self.delay > 0.0 { 0.0 } else { 0.5 * since * (since - span) };
        let since = (1.0 - self.delay) * since;
        let late = since - 0.5 * span;
        BodyState {
            position: self.position + DVec2::new(since * x + bend * ax, since * y + bend * ay),
            angle: self.angle + since * spin + bend * turning,
            velocity: DVec2::new(u + late * ax, v + late * ay),
            angular_velocity: turn + late * turning,
        }
    }
}

/// Bound on the way [m] of any point of a body with a given reach [m] in a displacement, or on its speed [m/s].
#[inline]
pub(super) fn farthest(reach: f64, [x, y, turn]: Motion3) -> f64 {
    DVec2::new(x, y).length() + turn.abs() * reach
}

/// What bodies do at the start of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    courses: Vec<Course>,
    ways: Vec<f64>,
    movings: Vec<Moving>,
}

/// All bodies; a fixed one has no inverse mass, and moves as it is told.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Bodies {
    pub(super) natures: Vec<Nature>,
    pub(super) courses: Vec<Course>,
    /// Inverse inertia of each body in a step: damping resists an impulse by the half of the kick in which it has acted.
    in_step: Vec<InverseInertia>,
    /// Length of the kick [s] that this holds for.
    kick: f64,
    /// Bound on the way [m] that any point of each body has gone in all.
    pub(super) ways: Vec<f64>,
    /// Motions at the start of the present step: poses there, velocities as they are known before it.
    pub(super) movings: Vec<Moving>,
    /// Smallest thickness of all bodies [m].
    pub(super) least_thickness: f64,
}

impl Bodies {
    pub(super) fn new(parts: Vec<BodyPart>, start: f64) -> Self {
        let courses = parts.iter().map(|BodyPart { body, state, motion, .. }| {
            let velocity = match motion {
                Some(motion) if body.is_fixed() => motion.laws().map(|law| law.at(start).rate),
                _ if body.is_fixed() => [0.0; 3],
                _ => [state.velocity.x, state.velocity.y, state.angular_velocity],
            };
            Course {
                position: state.position,
                angle: state.angle,
                middle: velocity,
                smooth: velocity,
                ..Course::default()
            }
        });
        let courses: Vec<Course> = courses.collect();
        let movings = courses.iter().map(|course| Moving::from(&course.state_at(0.0, 0.0))).collect();
        let natures = parts.into_iter().map(|BodyPart { body, free_motion, state, surface, motion }| {
            let free_motion = if body.is_fixed() { FreeMotion::default() } else { free_motion };
            let (reach, area) = (body.shape.reach(), body.shape.mass_properties().area);
            let is_convex = body.shape.is_convex();
            let moved = motion.filter(|motion| body.is_fixed() && !motion.is_uniform());
            let moved = moved.map(|motion| MovedPath::new(motion, state.position, state.angle, start));
            let moved = moved.map(|path| (path, start));
            Nature { reach, is_convex, thickness: 0.5 * area / reach, body, free_motion, surface, moved }
        });
        let natures: Vec<Nature> = natures.collect();
        let least_thickness = natures.iter().map(|nature| nature.thickness).fold(f64::INFINITY, f64::min);
        Self {
            least_thickness,
            ways: vec![0.0; courses.len()],
            in_step: Vec::new(),
            kick: 0.0,
            natures,
            courses,
            movings,
        }
    }

    /// Leads bodies that are moved as they are told through a step of a length `span` [s] that begins at a time [s].
    pub(super) fn lead(&mut self, time: f64, span: f64) {
        for ((nature, course), moving) in self.natures.iter().zip(&mut self.courses).zip(&mut self.movings) {
            let Some((path, start)) = &nature.moved else { continue };
            let offset = time - start;
            let (now, end) = (path.state_at(offset), path.state_at(offset + span));
            let way = end.position - course.position;
            let middle = [way.x, way.y, end.angle - course.angle].map(|way| way / span);
            let acceleration = path.acceleration_at(offset + 0.5 * span);
            (course.middle, course.smooth) = (middle, middle);
            course.acceleration = [acceleration.linear.x, acceleration.linear.y, acceleration.angular];
            (moving.velocity, moving.angular_velocity) = (now.velocity, now.angular_velocity);
        }
    }

    /// Sets the length of the kick [s] that leads to the middle of the step.
    pub(super) fn set_kick(&mut self, kick: f64) {
        if self.kick == kick {
            return;
        }
        self.kick = kick;
        self.in_step.clear();
        self.in_step.extend(self.natures.iter().map(|Nature { body, free_motion, .. }| InverseInertia {
            inverse_mass: body.inverse_mass / (1.0 + 0.5 * kick * free_motion.linear_rate),
            inverse_moment: body.inverse_moment / (1.0 + 0.5 * kick * free_motion.angular_rate),
        }));
    }

    /// Inverse inertia of a body, or of the background, against the impulses of a step.
    #[inline]
    pub(super) fn inertia_in_step(&self, place: usize) -> InverseInertia {
        let none = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        self.in_step.get(place).copied().unwrap_or(none)
    }

    #[inline]
    pub(super) fn count(&self) -> usize {
        self.natures.len()
    }

    /// Bound on the way [m] that points of two bodies, where these are near each other, go past each other in a time `span` [s] at given
    /// velocities: less than the sum of their ways where they are carried along together, as by a drum that turns.
    pub(super) fn way_past(&self, [a, b]: [usize; 2], velocities: [Motion3; 2], span: f64) -> f64 {
        let reaches = [a, b].map(|place| self.natures[place].reach);
        let (own, other) = if reaches[0] <= reaches[1] { (0, 1) } else { (1, 0) };
        let places = [a, b].map(|place| self.courses[place].position);
        let motion = velocities.map(|[x, y, _]| DVec2::new(x, y));
        let turns = velocities.map(|[.., turn]| turn);
        let past = motion[own] - motion[other];
        // As seen from the larger body, which turns a little on the way.
        let seen = past - turns[other] * (places[own] - places[other]).perp();
        let turned =
            turns[other].abs() * span * past.length() + (turns[own] - turns[other]).abs() * reaches[own];
        span * (seen.length() + turned)
    }

    /// Thickness of the thinner of two bodies [m].
    #[inline]
    pub(super) fn thinner(&self, [a, b]: [usize; 2]) -> f64 {
        self.natures[a].thickness.min(self.natures[b].thickness)
    }

    /// True for a body that no force moves, and for the background.
    #[inline]
    pub(super) fn is_fixed(&self, body: BodyId) -> bool {
        body.is_world() || self.natures[body.index()].body.is_fixed()
    }

    /// Motion of a body at the start of the present step; the background rests at the origin.
    #[inline]
    pub(super) fn moving(&self, body: BodyId) -> Moving {
        if body.is_world() { Moving::BACKGROUND } else { self.movings[body.index()] }
    }

    #[inline]
    pub(super) fn inertia(&self, body: BodyId) -> InverseInertia {
        if body.is_world() {
            return InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        }
        let Body { inverse_mass, inverse_moment, .. } = self.natures[body.index()].body;
        InverseInertia { inverse_mass, inverse_moment }
    }

    /// A body, or the background, at a velocity in a step.
    #[inline]
    pub(super) fn mover(&self, place: usize, velocity: Motion3) -> Mover {
        let InverseInertia { inverse_mass, inverse_moment } = self.inertia_in_step(place);
        Mover { velocity, inverse_mass, inverse_moment }
    }

    /// Brings all bodies to a time `since` [s] the start of the present step of a length `span` [s].
    pub(super) fn go_to(&mut self, since: f64, span: f64) {
        for place in 0..self.count() {
            let course = self.courses[place];
            self.place(place, &course.state_at(since, span));
            self.note_way(place, course.middle.map(|velocity| velocity * (1.0 - course.delay) * since));
        }
    }

    /// Keeps what the bodies do in `places`.
    pub(super) fn keep_places(&self, Places { courses, ways, movings }: &mut Places) {
        courses.clone_from(&self.courses);
        ways.clone_from(&self.ways);
        movings.clone_from(&self.movings);
    }

    /// Lets the bodies do again what was kept.
    pub(super) fn restore_places(&mut self, Places { courses, ways, movings }: &Places) {
        self.courses.clone_from(courses);
        self.ways.clone_from(ways);
        self.movings.clone_from(movings);
    }

    /// Sets a place anew, with the velocity that is known there.
    pub(super) fn place(&mut self, body: usize, state: &BodyState) {
        let course = &mut self.courses[body];
        (course.position, course.angle) = (state.position, state.angle);
        self.movings[body] = Moving::from(state);
    }

    /// Adds to the way of a body that of a displacement.
    pub(super) fn note_way(&mut self, body: usize, displacement: Motion3) {
        self.ways[body] += farthest(self.natures[body].reach, displacement);
    }

    /// Shifts a body at the start of the present step.
    pub(super) fn shift(&mut self, body: usize, [x, y, turn]: Motion3) {
        self.note_way(body, [x, y, turn]);
        let (course, moving) = (&mut self.courses[body], &mut self.movings[body]);
        course.position += DVec2::new(x, y);
        course.angle += turn;
        let Moving { velocity, angular_velocity, .. } = *moving;
        let state = BodyState { position: course.position, angle: course.angle, velocity, angular_velocity };
        *moving = Moving::from(&state);
    }

    /// Kinetic energy [J] of a body at given velocities.
    pub(super) fn kinetic_energy(&self, body: usize, [x, y, spin]: Motion3) -> f64 {
        let Body { inverse_mass, inverse_moment, .. } = self.natures[body].body;
        if inverse_mass > 0.0 {
            0.5 * ((x * x + y * y) / inverse_mass + spin * spin / inverse_moment)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfgap_geometry::Shape;

    /// Discs of radii 5 m and 1 m at two places.
    fn two_discs(places: [DVec2; 2]) -> Bodies {
        let parts = places.into_iter().zip([5.0, 1.0]).map(|(position, radius)| {
            let shape = Shape::disc(radius).expect("a fine radius");
            let body = Body { shape, inverse_mass: 1.0, inverse_moment: 1.0, elasticity: 0.0 };
            let state = BodyState { position, ..BodyState::default() };
            BodyPart::new(body, FreeMotion::default(), state)
        });
        Bodies::new(parts.collect(), 0.0)
    }

    #[test]
    fn what_a_drum_carries_along_goes_past_nothing_and_what_slides_goes_as_far_as_it_slides() {
        let bodies = two_discs([DVec2::ZERO, DVec2::new(0.0, -4.0)]);
        let (turn, span) = (0.5, 0.01);
        // The small disc lies on the inside of the large one, and turns with it about its centre.
        let carried = [[0.0, 0.0, turn], [4.0 * turn, 0.0, turn]];
        let past = bodies.way_past([0, 1], carried, span);
        assert!(past < 0.01 * span * 4.0 * turn, "{past} m");
        let sliding = [[0.0, 0.0, turn], [0.0, 0.0, 0.0]];
        let past = bodies.way_past([0, 1], sliding, span);
        assert!(past >= span * turn * 5.0 && past < span * turn * 5.1, "{past} m");
        assert_eq!(past, bodies.way_past([1, 0], [sliding[1], sliding[0]], span));
    }

    #[test]
    fn a_step_under_constant_acceleration_is_a_parabola() {
        let (v, a, span) = (3.0, -10.0, 0.5);
        let course = Course {
            middle: [v + 0.5 * span * a, 0.0, 0.0],
            smooth: [v + 0.5 * span * a, 0.0, 0.0],
            acceleration: [a, 0.0, 0.0],
            ..Course::default()
        };
        for share in 0..=4 {
            let since = 0.25 * f64::from(share) * span;
            let state = course.state_at(since, span);
            assert!((state.position.x - (v * since + 0.5 * a * since * since)).abs() < 1e-15);
            assert!((state.velocity.x - (v + a * since)).abs() < 1e-15);
        }
    }
}
