//! Force laws of one's own that change branch, that act over a short way, and that count turns.

use halfgap::force::{ForceLaw, Snapshot, Wrenches};
use halfgap::geometry::DVec2;
use halfgap::{BodyId, BodySpec, BodyState, Intervention, World, WorldBuilder, WorldSettings};
use halfgap_tests::mechanism::{Workshop, advance, at_rest, disc, thrown};
use std::sync::Arc;

/// A force along x between two places, or two times; it jumps at both.
#[derive(Debug)]
struct Window {
    body: [BodyId; 1],
    /// Where it begins and ends, in metres or seconds.
    ends: [f64; 2],
    force: f64,
    is_of_time: bool,
}

impl Window {
    fn place(&self, now: &Snapshot<'_>) -> f64 {
        if self.is_of_time { now.time } else { now.body(self.body[0]).pose.position.x }
    }
}

impl ForceLaw for Window {
    fn name(&self) -> &'static str {
        "window"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let place = self.place(now);
        if self.ends[0] < place && place < self.ends[1] {
            wrenches.add_force(self.body[0], DVec2::new(self.force, 0.0), DVec2::ZERO);
        }
    }

    fn switches(&self) -> usize {
        2
    }

    fn switch(&self, index: usize, now: &Snapshot<'_>) -> f64 {
        self.place(now) - self.ends[index]
    }
}

/// A smooth force along x at x = `from`, which acts over a given way: a bell curve with unit work.
#[derive(Debug)]
struct Kick {
    body: [BodyId; 1],
    from: f64,
    width: f64,
}

impl ForceLaw for Kick {
    fn name(&self) -> &'static str {
        "kick"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let off = (now.body(self.body[0]).pose.position.x - self.from) / self.width;
        let force = (-0.5 * off * off).exp() / (self.width * std::f64::consts::TAU.sqrt());
        wrenches.add_force(self.body[0], DVec2::new(force, 0.0), DVec2::ZERO);
    }

    fn length(&self, _: &Snapshot<'_>) -> Option<f64> {
        Some(self.width)
    }
}

/// A spiral spring of 1 N m/rad between the background and a body.
#[derive(Debug)]
struct SpiralSpring {
    body: [BodyId; 1],
    has_potential: bool,
}

impl ForceLaw for SpiralSpring {
    fn name(&self) -> &'static str {
        "spiral spring"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        wrenches.add_torque(self.body[0], -now.body(self.body[0]).angle);
    }

    fn potential(&self, now: &Snapshot<'_>) -> Option<f64> {
        let angle = now.body(self.body[0]).angle;
        self.has_potential.then_some(0.5 * angle * angle)
    }
}

/// A disc of 1 kg that moves along x at 1 m/s under a law.
fn under(tolerance: f64, law: impl FnOnce([BodyId; 1]) -> Arc<dyn ForceLaw>) -> (World, BodyId) {
    let mut builder = WorldBuilder::new(WorldSettings { tolerance, ..WorldSettings::default() });
    let state: BodyState = thrown(0.0, 0.0, DVec2::X);
    let body = builder.add(BodySpec::movable("disc", disc(0.5), 1.0, state));
    builder.add_force(law([body]));
    (builder.build().expect("a fine world"), body)
}

#[test]
fn a_force_that_jumps_does_all_of_its_work_wherever_steps_fall() {
    // In place the force does 1 J, in time it gives 1 N s. A step that leads over the window or into it has stages
    // on both sides of a jump.
    for (is_of_time, expected) in [(false, 3f64.sqrt()), (true, 2.0)] {
        for width in [0.1, 0.03, 1e-3] {
            for tolerance in [1e-2, 1e-5, 1e-8, 1e-10] {
                for case in 0..20 {
                    let from = 0.2 + 0.025 * f64::from(case);
                    let (mut world, body) = under(tolerance, |body| {
                        let ends = [from, from + width];
                        Arc::new(Window { body, ends, force: 1.0 / width, is_of_time })
                    });
                    // Before the jump nothing has happened: a look at the state must not tell otherwise.
                    advance(&mut world, 0.99 * from);
                    assert!((world.state(body).velocity.x - 1.0).abs() < 1e-14);
                    advance(&mut world, 2.0);
                    let off = (world.state(body).velocity.x - expected).abs();
                    assert!(
                        off < 1e-11,
                        "of time: {is_of_time}, from {from}, {width} wide, at {tolerance:e}: off by {off} m/s"
                    );
                }
            }
        }
    }
}

#[test]
fn a_free_body_does_not_step_over_a_force_whose_length_is_told() {
    for tolerance in [1e-3, 1e-6, 1e-10] {
        for case in 0..20 {
            let from = 0.5 + 0.031 * f64::from(case);
            let (mut world, body) = under(tolerance, |body| Arc::new(Kick { body, from, width: 0.01 }));
            advance(&mut world, 2.0);
            let off = (world.state(body).velocity.x - 3f64.sqrt()).abs();
            assert!(off < 10.0 * tolerance, "from {from}, at {tolerance:e}: off by {off} m/s");
        }
    }
}

#[test]
fn a_spiral_spring_is_wound_up_by_turns() {
    /// BodyAcceleration of the wheel [rad/s] as its spring is relaxed: it turns by three turns to either side.
    const SPIN: f64 = 20.0;
    const TOLERANCE: f64 = 1e-9;
    for (is_pinned, has_potential) in [(false, true), (false, false), (true, true), (true, false)] {
        let mut workshop = Workshop::weightless(TOLERANCE);
        let state = BodyState { angular_velocity: SPIN, ..at_rest(0.0, 0.0) };
        let wheel = workshop.inert("wheel", disc(0.5), [1.0, 1.0], state);
        if is_pinned {
            workshop.pin(BodyId::WORLD, wheel, DVec2::ZERO);
        }
        workshop.builder.add_force(Arc::new(SpiralSpring { body: [wheel], has_potential }));
        let mut world = workshop.build();
        for step in 1..=40 {
            let time = 0.25 * f64::from(step);
            advance(&mut world, time);
            let state = world.state(wheel);
            let off = (state.angle - SPIN * time.sin()).abs();
            assert!(off < 100.0 * SPIN * TOLERANCE, "pinned: {is_pinned}, at {time} s: off by {off} rad");
            // A touch that changes nothing starts the motion anew, with the turns taken out of its angle.
            let touch = Intervention::Impulse { body: wheel, impulse: DVec2::ZERO, point: DVec2::ZERO };
            world.intervene(&[touch], &mut |_| ()).expect("it may be touched");
            let drift = world.ledger().integration_error();
            assert!(drift.abs() < 1e-6, "pinned: {is_pinned}, potential: {has_potential}: {drift} J");
        }
    }
}
