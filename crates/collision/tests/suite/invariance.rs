//! First contact and motion bounds do not depend on the way in which a case is written down.

use glam::DVec2;
use halfgap_collision::{
    BodyState, FirstContact, Flight, Motion, MovingShape, Search, SearchSettings, Tolerances, first_contact,
    search_step,
};
use halfgap_geometry::Shape;
use proptest::prelude::*;

/// A body in flight, as numbers that can be transformed.
#[derive(Clone, Copy, Debug)]
struct Thrown {
    kind: usize,
    size: f64,
    state: BodyState,
    acceleration: DVec2,
    rates: [f64; 2],
}

impl Thrown {
    fn shape(&self) -> Shape {
        let size = self.size;
        let built = match self.kind {
            0 => Shape::disc(0.5 * size),
            1 => Shape::block(size, 0.5 * size),
            2 => Shape::capsule(size, 0.25 * size),
            3 => Shape::rounded_block(size, 0.5 * size, 0.125 * size),
            _ => Shape::ring(size, 0.75 * size),
        };
        built.expect("fine measures")
    }

    fn flight(&self) -> Flight {
        Flight::new(self.state, self.acceleration, self.rates[0], self.rates[1])
    }
}

#[derive(Clone, Copy, Debug)]
struct Case {
    a: Thrown,
    b: Thrown,
    span: f64,
    target: f64,
}

impl Case {
    fn search(&self, settings: Option<&SearchSettings>) -> Option<FirstContact> {
        let (shapes, flights) = ([self.a.shape(), self.b.shape()], [self.a.flight(), self.b.flight()]);
        let [a, b] =
            [0, 1].map(|side| MovingShape { shape: &shapes[side], motion: &flights[side], offset: 0.0 });
        let tolerances =
            Tolerances { target_gap: self.target, accuracy: 0.6 * self.target, velocity_tol: self.target };
        let Some(settings) = settings else {
            return match first_contact(&a, &b, self.span, &tolerances, &SearchSettings::default()) {
                Search::Contact(contact) => Some(contact),
                Search::NoneBefore(_) => None,
            };
        };
        let mut from = 0.0;
        loop {
            match search_step(&a, &b, from, self.span, &tolerances, settings) {
                Search::Contact(contact) => return Some(contact),
                Search::NoneBefore(time) if time >= self.span => return None,
                Search::NoneBefore(time) => {
                    assert!(time > from, "every call makes progress");
                    from = time;
                }
            }
        }
    }

    fn each(self, change: impl Fn(Thrown) -> Thrown) -> Self {
        Self { a: change(self.a), b: change(self.b), ..self }
    }

    /// True if the two answers agree: the same time to rounding, or a graze that may go either way.
    fn agrees(&self, one: Option<FirstContact>, other: Option<FirstContact>) -> bool {
        match (one, other) {
            (Some(one), Some(other)) => (one.time - other.time).abs() <= 1e-9 * self.span,
            (None, None) => true,
            _ => false,
        }
    }
}

fn any_thrown(toward: f64) -> impl Strategy<Value = Thrown> {
    let number = || -1.0..1.0f64;
    let rates = prop::option::of(0.0..0.3f64).prop_map(|rate| [rate.unwrap_or(0.0); 2]);
    let spin = prop_oneof![Just(0.0), -4.0..4.0f64];
    let turned = (0..5usize, 0.5..1.0f64, number(), number(), -3.2..3.2f64, spin);
    (turned, number(), number(), rates).prop_map(move |((kind, size, y, vy, angle, spin), ax, ay, rates)| {
        Thrown {
            kind,
            size,
            state: BodyState {
                position: DVec2::new(-2.0 * toward, 0.5 * y),
                angle,
                velocity: DVec2::new(1.5 * toward, 0.3 * vy),
                angular_velocity: spin,
            },
            acceleration: DVec2::new(ax, ay) * 0.3,
            rates,
        }
    })
}

fn any_case() -> impl Strategy<Value = Case> {
    (any_thrown(1.0), any_thrown(-1.0), prop_oneof![Just(1e-3), Just(1e-7)]).prop_map(|(a, b, target)| Case {
        a,
        b,
        span: 4.0,
        target,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn swapping_the_bodies_swaps_the_features(case in any_case()) {
        let (one, other) = (case.search(None), Case { a: case.b, b: case.a, ..case }.search(None));
        prop_assert!(case.agrees(one, other), "{:?} and {:?}", one, other);
    }

    #[test]
    fn a_rigid_motion_of_everything_changes_nothing(case in any_case(), angle in -3.0..3.0f64, shift in -5.0..5.0f64) {
        let turn = DVec2::from_angle(angle);
        let moved = case.each(|body| Thrown {
            state: BodyState {
                position: turn.rotate(body.state.position) + DVec2::splat(shift),
                velocity: turn.rotate(body.state.velocity),
                angle: body.state.angle + angle,
                ..body.state
            },
            acceleration: turn.rotate(body.acceleration),
            ..body
        });
        let (one, other) = (case.search(None), moved.search(None));
        prop_assert!(case.agrees(one, other), "{:?} and {:?}", one, other);
    }

    #[test]
    fn a_mirror_changes_nothing(case in any_case()) {
        // All shapes here are their own mirror images.
        let flip = DVec2::new(1.0, -1.0);
        let mirrored = case.each(|body| Thrown {
            state: BodyState {
                position: body.state.position * flip,
                velocity: body.state.velocity * flip,
                angle: -body.state.angle,
                angular_velocity: -body.state.angular_velocity,
            },
            acceleration: body.acceleration * flip,
            ..body
        });
        let (one, other) = (case.search(None), mirrored.search(None));
        prop_assert!(case.agrees(one, other), "{:?} and {:?}", one, other);
    }

    #[test]
    fn powers_of_two_scale_length_and_time_exactly(case in any_case(), length in -8..8i32, time in -8..8i32) {
        let (length, time) = (2f64.powi(length), 2f64.powi(time));
        let scaled = Case { span: case.span * time, target: case.target * length, ..case }.each(|body| Thrown {
            size: body.size * length,
            state: BodyState {
                position: body.state.position * length,
                velocity: body.state.velocity * (length / time),
                angle: body.state.angle,
                angular_velocity: body.state.angular_velocity / time,
            },
            acceleration: body.acceleration * (length / (time * time)),
            rates: body.rates.map(|rate| rate / time),
            ..body
        });
        let (one, other) = (case.search(None), scaled.search(None));
        let back = other.map(|contact| FirstContact { time: contact.time / time, ..contact });
        prop_assert_eq!(one, back);
    }

    #[test]
    fn an_observer_in_motion_sees_the_same(case in any_case(), boost in (-3.0..3.0f64, -3.0..3.0f64)) {
        let boost = DVec2::new(boost.0, boost.1);
        // Damping is against a medium at rest, which an observer in motion sees moving.
        let free = case.each(|body| Thrown { rates: [0.0, body.rates[1]], ..body });
        let seen = free.each(|body| Thrown {
            state: BodyState { velocity: body.state.velocity + boost, ..body.state },
            ..body
        });
        let (one, other) = (free.search(None), seen.search(None));
        prop_assert!(case.agrees(one, other), "{:?} and {:?}", one, other);
    }

    #[test]
    fn a_search_in_many_small_calls_finds_the_same(case in any_case(), march_steps in 1..6u32) {
        let small = SearchSettings { march_steps, windows: 1, crowded: 2, direct_pairs: 4, ..SearchSettings::default() };
        let (one, other) = (case.search(None), case.search(Some(&small)));
        prop_assert!(case.agrees(one, other), "{:?} and {:?}", one, other);
    }

    #[test]
    fn bounds_hold_what_they_say(body in any_thrown(1.0), from in 0.0..2.0f64, length in 0.0..3.0f64) {
        let flight = body.flight();
        let bounds = flight.bounds(from, from + length);
        for step in 0..=50 {
            let time = from + length * f64::from(step) / 50.0;
            let state = flight.state_at(time);
            let within = |ball: halfgap_collision::Ball, value: DVec2| {
                (value - ball.center).length() <= ball.radius + 1e-14 * (1.0 + value.length())
            };
            prop_assert!(within(bounds.velocity, state.velocity));
            prop_assert!(within(bounds.acceleration, flight.acceleration_at(time)));
            prop_assert!(state.angular_velocity.abs() <= bounds.angular_speed * (1.0 + 1e-15));
            prop_assert!(flight.angular_acceleration_at(time).abs() <= bounds.angular_acceleration * (1.0 + 1e-15));
        }
    }
}
