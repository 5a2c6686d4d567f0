//! Failures: a scene that cannot be simulated is told, with all events before, and told again at every further try.

use glam::DVec2;
use halfgap::force::{ForceLaw, Snapshot, Spring, Wrenches};
use halfgap::geometry::Shape;
use halfgap::{
    Anchor, BodyId, BodySpec, BodyState, Connector, ConnectorKind, ConnectorSpec, Event, Integrator,
    Intervention, RunError, SlotFrame, ToleranceOverrides, World, WorldBuilder, WorldError, WorldSettings,
};
use std::sync::Arc;

/// A force law whose gravity [m/s^2] on a body is NaN once the body rises.
#[derive(Debug)]
struct OnlyDown([BodyId; 1]);

const GRAVITY: f64 = 9.81;

impl ForceLaw for OnlyDown {
    fn name(&self) -> &str {
        "only down"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.0
    }

    fn apply(&self, now: &Snapshot<'_>, out: &mut Wrenches<'_>) {
        let rises = now.body(self.0[0]).velocity.y > 0.0;
        let force = if rises { f64::NAN } else { -GRAVITY };
        out.add_force(self.0[0], DVec2::new(0.0, force), DVec2::ZERO);
    }
}

/// A ball of 1 kg that falls 2 m onto a floor, and cannot come up again.
fn falling_ball() -> (World, BodyId) {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let floor = Shape::block(10.0, 1.0).expect("a fine size");
    builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
    let state = BodyState { position: DVec2::new(0.0, 2.5), ..BodyState::default() };
    let disc = Shape::disc(0.5).expect("a fine radius");
    let ball = builder.add(BodySpec::movable("ball", disc, 1.0, state));
    builder.add_force(Arc::new(OnlyDown([ball])));
    (builder.build().expect("it falls"), ball)
}

#[test]
fn an_impact_after_which_nothing_can_go_on_is_told_and_so_is_every_try() {
    let (mut world, ball) = falling_ball();
    let mut events: Vec<Event> = Vec::new();
    let failed = world.advance_to(2.0, &mut |event| events.push(event.clone()));
    let Err(RunError::StepCollapsed { time, .. }) = &failed else { panic!("{failed:?}") };
    assert!((time - (4.0 / GRAVITY).sqrt()).abs() < 1e-6, "{time} s");
    let [Event::Impact(impact)] = &events[..] else { panic!("{events:?}") };
    assert_eq!((impact.time, impact.rows.len()), (*time, 1));
    assert_eq!(world.ledger().impacts, impact.energy_change);
    for _ in 0..2 {
        let again = world.advance_to(3.0, &mut |event| panic!("{event:?}"));
        assert_eq!((&again, world.time()), (&failed, *time));
    }
    assert_eq!(world.advance_to(0.5, &mut |event| panic!("{event:?}")), Ok(()), "that is past");
    let down = Intervention::Velocity { body: ball, velocity: DVec2::NEG_Y, angular_velocity: 0.0 };
    assert_eq!(world.intervene(&[down], &mut |event| panic!("{event:?}")), failed, "nothing helps any more");
}

#[test]
fn an_intervention_after_which_nothing_can_go_on_is_told_again_where_nothing_else_happens() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let disc = Shape::disc(0.5).expect("a fine radius");
    let ball = builder.add(BodySpec::movable("ball", disc, 1.0, BodyState::default()));
    builder.add_force(Arc::new(OnlyDown([ball])));
    let mut world = builder.build().expect("it falls");
    world.advance_to(1.0, &mut |_| ()).expect("it goes down");
    let up = Intervention::Velocity { body: ball, velocity: DVec2::Y, angular_velocity: 0.0 };
    let failed = world.intervene(&[up], &mut |_| ());
    assert!(matches!(failed, Err(RunError::StepCollapsed { .. })), "{failed:?}");
    assert_eq!(world.advance_to(2.0, &mut |_| ()), failed);
}

#[test]
fn steps_too_long_for_a_spring_are_told_before_nothing_comes_to_an_end_any_more() {
    /// Stiffness [N/m] of a spring with a ball of 1 kg, and a step [s] in which it would swing four times.
    const STIFFNESS: f64 = 1e6;
    const STEP: f64 = 0.025;
    let settings =
        WorldSettings { integrator: Integrator::Euler, time_step: Some(STEP), ..WorldSettings::default() };
    let mut builder = WorldBuilder::new(settings);
    let disc = Shape::disc(0.5).expect("a fine radius");
    let state = BodyState { position: DVec2::X, ..BodyState::default() };
    let ball = builder.add(BodySpec::movable("ball", disc, 1.0, state));
    let ends = [end(BodyId::WORLD.0, DVec2::new(0.0, 2.0)), end(ball.0, DVec2::ZERO)];
    builder.add_force(Arc::new(Spring::new("spring", ends, 0.5, STIFFNESS)));
    let mut world = builder.build().expect("it swings");
    let failed = world.advance_to(100.0, &mut |_| ());
    let Err(RunError::RanAway { speed, bodies, .. }) = &failed else { panic!("{failed:?}") };
    assert_eq!(bodies.as_slice(), ["ball".to_owned()]);
    assert!(*speed > 1e8, "{speed} m/s");
}

#[test]
fn a_gap_that_is_lost_in_rounding_is_refused() {
    let build = |target_gap: f64, accuracy: Option<f64>| {
        let overrides =
            ToleranceOverrides { target_gap: Some(target_gap), accuracy, ..ToleranceOverrides::default() };
        let mut builder = WorldBuilder::new(WorldSettings { overrides, ..WorldSettings::default() });
        let disc = Shape::disc(0.5).expect("a fine radius");
        let state = BodyState { position: DVec2::new(3.5, 0.0), ..BodyState::default() };
        builder.add(BodySpec::movable("ball", disc, 1.0, state));
        builder.build().map(|_| ())
    };
    assert!(build(1e-13, None).is_ok());
    let refused =
        |setting: &str| format!("{setting} must be at least 7.11e-15 m for coordinates of 4 m, got 1e-15 m");
    let gap = build(1e-15, None);
    assert!(matches!(&gap, Err(error) if error.to_string() == refused("target_gap")), "{gap:?}");
    let accuracy = build(1e-6, Some(1e-15));
    assert!(matches!(&accuracy, Err(error) if error.to_string() == refused("accuracy")), "{accuracy:?}");
}

/// A law that pushes a given one of its two bodies, though it may name another.
#[derive(Debug)]
struct Push([BodyId; 2], usize);

impl ForceLaw for Push {
    fn name(&self) -> &str {
        "push"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.0[..self.1]
    }

    fn apply(&self, _: &Snapshot<'_>, out: &mut Wrenches<'_>) {
        out.add_force(self.0[1], DVec2::X, DVec2::ZERO);
    }
}

#[test]
fn a_law_that_acts_on_a_body_it_does_not_name_is_refused() {
    for (named, is_fine) in [(2, true), (1, false)] {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        let bodies = [("first", 0.0), ("second", 5.0)].map(|(name, x)| {
            let state = BodyState { position: DVec2::new(x, 0.0), ..BodyState::default() };
            let disc = Shape::disc(0.5).expect("a fine radius");
            builder.add(BodySpec::movable(name, disc, 1.0, state))
        });
        builder.add_force(Arc::new(Push(bodies, named)));
        let refused = WorldError::UnnamedBody { law: "push".to_owned(), body: "second".to_owned() };
        assert_eq!(builder.build().err(), (!is_fine).then_some(refused));
    }
}

#[test]
fn that_another_law_names_the_body_helps_nothing() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let bodies = [("first", 0.0), ("second", 5.0)].map(|(name, x)| {
        let state = BodyState { position: DVec2::new(x, 0.0), ..BodyState::default() };
        let disc = Shape::disc(0.5).expect("a fine radius");
        builder.add(BodySpec::movable(name, disc, 1.0, state))
    });
    builder.add_force(Arc::new(Push(bodies, 1)));
    builder.add_force(Arc::new(OnlyDown([bodies[1]])));
    let refused = WorldError::UnnamedBody { law: "push".to_owned(), body: "second".to_owned() };
    assert_eq!(builder.build().err(), Some(refused));
}

#[test]
fn a_connector_with_numbers_that_none_can_have_is_refused() {
    let rope = |length| ConnectorKind::Rope { a: end(0, DVec2::ZERO), b: end(1, DVec2::ZERO), length };
    let slot = |normal| ConnectorKind::Slot {
        a: end(0, DVec2::ZERO),
        b: end(1, DVec2::ZERO),
        normal,
        frame: SlotFrame::World,
    };
    let cases = [
        (rope(f64::NAN), 0.5, "the length of a rod or rope must be positive and finite, got NaN m"),
        (rope(2.0), 3.0, "elasticity must lie between 0 and 1, got 3"),
        (slot(DVec2::ZERO), 0.0, "the normal of a slot must be a direction, finite and not 0, got (0, 0)"),
        (
            ConnectorKind::Pin { a: end(1, DVec2::ZERO), b: end(1, DVec2::X) },
            0.0,
            "a connector needs two different bodies",
        ),
    ];
    for (kind, elasticity, why) in cases {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        for name in ["first", "second"] {
            let disc = Shape::disc(0.5).expect("a fine radius");
            builder.add(BodySpec::movable(name, disc, 1.0, BodyState::default()));
        }
        builder.add_connector(ConnectorSpec::new(Connector { kind, elasticity }));
        let refused = builder.build().expect_err("no such connector").to_string();
        assert!(refused.starts_with("connector 0 (") && refused.ends_with(why), "{refused}");
    }
}

fn end(body: u32, point: DVec2) -> Anchor {
    Anchor { body: BodyId(body), point }
}

#[test]
fn a_time_that_never_comes_is_refused() {
    let (mut world, _) = falling_ball();
    for time in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        assert_eq!(world.advance_to(time, &mut |_| ()), Err(RunError::NotATime));
    }
    assert_eq!(world.time(), 0.0);
}
