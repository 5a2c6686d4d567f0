//! The horizon of a pair's search: a little beyond the first contact known of its bodies, for that changes their
//! motions. Later contacts are searched for if it has not come.

use crate::rigid::search::searching::Searching;
use crate::rigid::shares::WORTHWHILE;
use crate::time::Time;
use halfgap_collision::BodyId;

/// Time by which a search goes beyond the first contact, as a fraction of the time until it: where the contact's time
/// is corrected, contacts that come close after it are known.
const BEYOND: f64 = 1.0 / 8.0;

impl Searching<'_> {
    /// Time, at most `until`, up to which two bodies are searched from a time on.
    pub(crate) fn searched_until(&self, bodies: [BodyId; 2], from: Time, until: Time) -> Time {
        let [a, b] = bodies.map(|body| self.search.first_contacts[self.assembly.slot(body)]);
        let ahead = |contact: Time| if contact > from { contact } else { Time::NEVER };
        let wait = ahead(a).min(ahead(b)).since(from) * (1.0 + BEYOND);
        if wait < WORTHWHILE * until.since(from) { from.plus(wait) } else { until }
    }

    /// Notes a contact of two bodies that a search from a time on has found.
    pub(crate) fn note_contact_ahead(&mut self, bodies: [BodyId; 2], from: Time, contact: Time) {
        for body in bodies.into_iter().filter(|&body| self.assembly.is_movable(body)) {
            let slot = self.assembly.slot(body);
            let first = &mut self.search.first_contacts[slot];
            // A contact that has gone by without a change of the motion no longer counts.
            *first = if *first > from { contact.min(*first) } else { contact };
        }
    }

    /// Forgets the first contact of a body whose motion has changed.
    pub(crate) fn forget_contacts_ahead(&mut self, body: BodyId) {
        self.search.first_contacts[body.index()] = Time::NEVER;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::bodies::trajectory::FreeMotion;
    use crate::rigid::contacts::pairs::Prediction;
    use crate::rigid::event::intervention::VelocityChange;

    use crate::rigid::parts::{BodyPart, RigidParts};
    use crate::rigid::system::RigidSystem;
    use crate::rigid::test_scene::FINE;
    use crate::system::EventDriven;
    use glam::DVec2;
    use halfgap_collision::{Body, BodyState};
    use halfgap_geometry::Shape;

    /// Time [s] at which the moving square meets the near one.
    const MEETS_NEAR: f64 = 0.05;
    /// Time [s] at which the moving square meets the far one, if the near one is away.
    const MEETS_FAR: f64 = 0.2;

    /// A square that moves at 1 m/s towards a small one, which has a large one behind it.
    fn squares_in_a_row() -> RigidSystem {
        let bodies = [(0.5, 0.0, 1.0), (0.05, 0.325, 0.0), (1.0, 0.95, 0.0)].map(|(side, x, speed)| {
            let shape = Shape::block(side, side).expect("a fine size");
            let body = Body { shape, inverse_mass: 1.0, inverse_moment: 1.0, elasticity: 1.0 };
            let (position, velocity) = (DVec2::new(x, 0.0), DVec2::new(speed, 0.0));
            let state = BodyState { position, velocity, ..BodyState::default() };
            BodyPart::new(body, FreeMotion::default(), state)
        });
        let parts = RigidParts { bodies: Vec::from(bodies), ..RigidParts::default() };
        RigidSystem::new(parts, FINE, Time::ZERO).expect("nothing rests")
    }

    #[test]
    fn contacts_after_the_first_one_are_not_looked_for() {
        let rooms = squares_in_a_row().into_rooms();
        let [moving, near, far] = [0, 1, 2].map(BodyId);
        let known = |a, b| {
            let pair = rooms.pairs.get(rooms.pairs.between(a, b).expect("they are near each other"));
            (pair.prediction(), pair.clear().seconds())
        };
        let (prediction, time) = known(moving, near);
        assert!(matches!(prediction, Prediction::Contact(_)) && (time - MEETS_NEAR).abs() < 1e-6);
        let (prediction, clear) = known(moving, far);
        assert!(prediction == Prediction::SearchOn && clear > MEETS_NEAR && clear < MEETS_FAR, "{clear}");
    }

    #[test]
    fn where_the_first_contact_does_not_come_the_next_is_found() {
        let mut system = squares_in_a_row();
        let near = BodyId(1);
        let away = VelocityChange { body: near, velocity: DVec2::new(0.0, 100.0), angular_velocity: 0.0 };
        system.intervene(Time::ZERO, &[away]).expect("nothing touches");
        let impact = loop {
            let handled = system.handle_next().expect("nothing is in the way");
            if let Some(handled) = handled.filter(|handled| handled.impact) {
                break handled.time.seconds();
            }
        };
        assert!((impact - MEETS_FAR).abs() < 1e-6, "{impact} s");
    }
}
