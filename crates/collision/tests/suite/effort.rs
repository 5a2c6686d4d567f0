//! Effort of a search: it looks at no more than can matter.

use glam::DVec2;
use halfgap_collision::{
    BodyState, Flight, Motion, MotionBounds, Moving, MovingShape, Polynomial, Search, SearchSettings,
    Tolerances, first_contact,
};
use halfgap_geometry::{Feature, Shape};
use std::cell::Cell;

const TOLERANCES: Tolerances = Tolerances { target_gap: 1e-8, accuracy: 6e-9, velocity_tol: 1e-9 };

/// A flight that counts the queries for the place of its body.
struct Counted {
    flight: Flight,
    looks: Cell<u32>,
}

impl Counted {
    fn new(position: DVec2, velocity: DVec2, spin: f64) -> Self {
        let state = BodyState { position, velocity, angular_velocity: spin, ..BodyState::default() };
        let flight = Flight::new(state, DVec2::new(0.0, -9.81), 0.0, 0.0);
        Self { flight, looks: Cell::new(0) }
    }

    fn look(&self) -> &Flight {
        self.looks.set(self.looks.get() + 1);
        &self.flight
    }
}

impl Motion for Counted {
    fn state_at(&self, offset: f64) -> BodyState {
        self.look().state_at(offset)
    }

    fn moving_at(&self, offset: f64) -> Moving {
        self.look().moving_at(offset)
    }

    fn center_at(&self, offset: f64) -> (DVec2, DVec2) {
        self.look().center_at(offset)
    }

    fn bounds(&self, from: f64, to: f64) -> MotionBounds {
        self.flight.bounds(from, to)
    }

    fn polynomial_from(&self, offset: f64) -> Option<Polynomial> {
        self.flight.polynomial_from(offset)
    }

    fn is_rotation_free(&self) -> bool {
        self.flight.is_rotation_free()
    }
}

/// Result of a search of two shapes over one second, and the number of queries for the place of the first.
fn search(shapes: [&Shape; 2], motions: [&Counted; 2]) -> (Search, u32) {
    let [a, b] = [0, 1].map(|side| MovingShape { shape: shapes[side], motion: motions[side], offset: 0.0 });
    let found = first_contact(&a, &b, 1.0, &TOLERANCES, &SearchSettings::STANDARD);
    (found, motions[0].looks.get())
}

#[test]
fn blocks_that_fly_side_by_side_are_seen_not_to_meet_at_a_glance() {
    let block = Shape::block(0.1, 0.1).expect("a fine size");
    let velocity = DVec2::new(30.0, -50.0);
    let motions = [0.0, 1.0].map(|x| Counted::new(DVec2::new(x, 0.0), velocity, 0.0));
    let (found, looks) = search([&block, &block], [&motions[0], &motions[1]]);
    assert_eq!(found, Search::NoneBefore(1.0));
    assert!(looks < 10, "{looks} looks");
}

#[test]
fn corners_that_cross_a_ring_are_not_looked_at_all_the_way() {
    /// Bound far below the number of looks for each corner in each window of time.
    const MOST_LOOKS: u32 = 60;
    let ring = Shape::ring(2.2, 2.0).expect("a fine ring");
    for corners in [4, 12] {
        let polygon = Shape::regular_polygon(corners, 0.2).expect("a fine size");
        let (body, fixed) = (
            Counted::new(DVec2::new(-1.5, 0.0), DVec2::new(4.0, 5.0), 2.0),
            Counted::new(DVec2::ZERO, DVec2::ZERO, 0.0),
        );
        let (found, looks) = search([&polygon, &ring], [&body, &fixed]);
        let Search::Contact(contact) = found else { panic!("{found:?}") };
        assert!(matches!(ring.feature(contact.feature_b), Feature::Round(arc) if arc.radius == -2.0));
        println!("{corners} corners: {looks} looks");
        assert!(looks < MOST_LOOKS, "{corners} corners: {looks} looks");
    }
}

#[test]
fn a_pin_that_is_slow_in_its_hole_is_not_followed_at_the_pace_of_its_bodies() {
    /// Clearance [m], and speed [m/s] at which pin and hole come together while both go round at metres a second.
    const CLEARANCE: f64 = 1e-5;
    const SPEED: f64 = 1e-4;
    const MOST_LOOKS: u32 = 1000;
    let arm = DVec2::new(0.3, 0.0);
    let pin = Shape::disc(0.05).expect("a fine radius").translated(arm);
    let hole = Shape::ring(0.1, 0.05 + CLEARANCE).expect("a fine ring").translated(arm);
    let motions = [DVec2::new(SPEED, 0.0), DVec2::ZERO].map(|v| Counted::new(DVec2::ZERO, v, 10.0));
    let (found, looks) = search([&pin, &hole], [&motions[0], &motions[1]]);
    let Search::Contact(contact) = found else { panic!("{found:?}") };
    let expected = (CLEARANCE - TOLERANCES.target_gap) / SPEED;
    assert!((contact.time - expected).abs() < 1e-9, "{} s, not {expected} s", contact.time);
    assert!(looks < MOST_LOOKS, "{looks} looks");
}
