//! The monitor: stops a world whose connectors, overlaps or energy books are out of bounds.
//!
//! Small broken invariants ([`Finding`]) are reported at the end of a run. After a connector has come apart, bodies lie
//! in one another, or energy has come from nowhere, all further motion is that of another scene: the advance ends with
//! an error there. The monitor looks where an advance stops, as often as costs next to nothing.

use crate::finding::Finding;
use crate::ledger::{Books, Turnover};
use crate::near::NearPairs;
use crate::run_error::RunError;
use crate::settings::WorldSettings;
use crate::world::World;
use halfgap_advance::rigid::Ledger as Booked;
use halfgap_collision::Moving;

/// Number of segments of motion from one look to the next, beside one for each body.
const SEGMENTS: u64 = 16;
/// Number of looks over the planned duration, if there is one, however few segments the run has.
pub(crate) const LOOKS: f64 = 50.0;
/// Fraction of the interval between such looks by which a stop may, by rounding, come too early for one.
const EARLY: f64 = 1e-6;

/// Memory of the monitor, and buffers for its looks.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct InvariantMonitor {
    /// Relative accuracy asked for [-].
    pub(crate) tolerance: f64,
    /// Time at the start [s].
    start: f64,
    /// Planned duration [s]; 0 if it is not known.
    pub(crate) duration: f64,
    pub(crate) scales: EnergyScales,
    /// Whether the caller has given the speed that counts as slow.
    pub(crate) slow_is_given: bool,
    /// Whether the caller has given the target gap.
    pub(crate) gap_is_given: bool,
    /// The energy in play since the start.
    pub(crate) turnover: Turnover,
    /// Number of segments that had been started at the last look.
    looked: u64,
    /// Number of the looks over the planned duration that are behind.
    looks: f64,
    /// Whether none of those looks was left out; false without a planned duration.
    pub(crate) is_watchful: bool,
    /// Whether the last advance ended with a look that found no fault. Connectors are together and bodies apart then,
    /// for nothing moves without another advance.
    pub(crate) is_sound: bool,
    /// The fault found, after which the world cannot go on, and its time [s].
    found: Option<(f64, Finding)>,
    #[cfg_attr(feature = "save", serde(skip))]
    room: Room,
}

/// Scales of the energy of a scene [J].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct EnergyScales {
    /// Usual energy of the scene; 0 where nothing moves.
    pub(crate) usual: f64,
    /// Work of the forces at the start along a target gap.
    pub(crate) rough: f64,
    /// Work of the forces and torques within the tolerance of the bodies' sizes, and energy of a speed that is rounding.
    pub(crate) lost: f64,
    /// Rounding of the correction at the start: velocities that it took away do not become exact zeros.
    pub(crate) left: f64,
}

/// Buffers for looks.
#[derive(Clone, Debug, Default)]
struct Room {
    booked: Booked,
    movings: Vec<Moving>,
    near: NearPairs,
}

impl InvariantMonitor {
    /// Makes the monitor of a scene with the given energies.
    pub(crate) fn new(settings: &WorldSettings, scales: EnergyScales) -> Self {
        let duration = settings.duration.unwrap_or_default();
        Self {
            tolerance: settings.tolerance,
            start: settings.start_time,
            duration,
            scales,
            slow_is_given: settings.overrides.velocity_tol.is_some(),
            gap_is_given: settings.overrides.target_gap.is_some(),
            turnover: Turnover::default(),
            looked: 0,
            looks: 0.0,
            is_watchful: duration > 0.0,
            is_sound: false,
            found: None,
            room: Room::default(),
        }
    }
}

impl World {
    /// Checks whether the monitor has stopped the world before.
    ///
    /// # Errors
    /// The fault that it has found.
    pub(crate) fn ask_guard(&self) -> Result<(), RunError> {
        match self.monitor.found.clone() {
            Some((time, finding)) => Err(RunError::Astray { time, finding }),
            None => Ok(()),
        }
    }

    /// Checks the world after an advance, if the advance ended with an error or enough has happened since the last
    /// look.
    ///
    /// # Errors
    /// [`RunError::Astray`] for a fault; else the error of the advance.
    pub(crate) fn stand_guard<T>(&mut self, outcome: Result<T, RunError>) -> Result<T, RunError> {
        let segments = self.steps();
        let is_soon = segments - self.monitor.looked < SEGMENTS + self.body_count() as u64;
        let is_due = self.is_look_due();
        self.monitor.is_sound = false;
        if outcome.is_ok() && is_soon && !is_due || !self.keeps_to_tolerance() {
            return outcome;
        }
        self.monitor.looked = segments;
        let mut room = std::mem::take(&mut self.monitor.room);
        let books = self.books(&mut room.booked, &mut room.movings);
        let kinetic = self.largest_kinetic_energy();
        self.monitor.turnover.note(&books);
        self.monitor.turnover.note_kinetic(kinetic);
        let found = self.astray(&books, &mut room.near);
        self.monitor.room = room;
        self.monitor.is_sound = found.is_none();
        match found {
            Some(finding) => {
                let time = self.time();
                self.monitor.found = Some((time, finding.clone()));
                Err(RunError::Astray { time, finding })
            }
            None => outcome,
        }
    }

    /// Returns the first fault beyond repair, if there is one.
    fn astray(&self, books: &Books, near: &mut NearPairs) -> Option<Finding> {
        let mut found = Vec::new();
        self.find_connectors_off(&mut found);
        self.find_overlaps(near, &mut found);
        found.into_iter().next().or_else(|| self.books_astray(books, self.monitor.turnover.energy))
    }

    /// True if the time of one of the looks over the planned duration has come.
    fn is_look_due(&mut self) -> bool {
        let now = self.time();
        let monitor = &mut self.monitor;
        if monitor.duration <= 0.0 {
            return false;
        }
        let looks = 1.0 + (LOOKS * (now - monitor.start) / monitor.duration + EARLY).floor();
        monitor.is_watchful &= looks <= monitor.looks + 1.0;
        let is_due = looks > monitor.looks;
        monitor.looks = monitor.looks.max(looks);
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        BodySpec, ConnectorSpec, Intervention, JointSpring, Motor, ToleranceOverrides, WorldBuilder,
    };
    use glam::DVec2;
    use halfgap_collision::{Anchor, BodyId, BodyState, Connector, ConnectorKind};
    use halfgap_geometry::Shape;

    /// Times [s] between which a pendulum makes more segments than the monitor lets pass.
    const LATER: f64 = 20.0;
    const LATER_STILL: f64 = 40.0;

    /// A pendulum that has swung for a while.
    fn pendulum() -> World {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        let shape = Shape::disc(0.5).expect("a fine radius");
        let state = BodyState { position: DVec2::new(1.0, 0.0), ..BodyState::default() };
        let body = builder.add(BodySpec::movable("bob", shape, 1.0, state));
        let [a, b] = [BodyId::WORLD, body].map(|body| Anchor { body, point: DVec2::ZERO });
        builder.add_connector(ConnectorSpec::new(rod(a, b, 1.0)));
        builder.add_gravity(body, DVec2::new(0.0, -10.0));
        let mut world = builder.build().expect("it hangs");
        world.advance_to(LATER, &mut |_| ()).expect("it swings");
        world
    }

    fn rod(a: Anchor, b: Anchor, length: f64) -> Connector {
        Connector::new(ConnectorKind::Rod { a, b, length }, 0.0).expect("a fine rod")
    }

    #[test]
    fn a_connector_that_is_off_ends_the_advance() {
        let mut world = pendulum();
        let ConnectorKind::Rod { a, b, .. } = world.connectors()[0].kind else { panic!("it is a rod") };
        // The monitor measures a longer rod than the one that holds the bob.
        world.joints.replace(0, rod(a, b, 1.0 + 1e-3));
        let outcome = world.advance_to(LATER_STILL, &mut |_| ());
        let Err(RunError::Astray { time, finding: Finding::ConnectorOff { error, .. } }) = &outcome else {
            panic!("{outcome:?}")
        };
        assert_eq!(*time, LATER_STILL);
        assert!((error - 1e-3).abs() < 1e-9, "{error}");
        let message = "at 40 s the world no longer holds together: connector 0 (rod of \"world\" and \"bob\") is off by 0.001 m";
        assert!(outcome.as_ref().is_err_and(|error| error.to_string() == message));
        // The error is repeated, as any other error, except for a time that has passed.
        assert_eq!(world.advance_to(LATER_STILL + 1.0, &mut |_| ()), outcome);
        let stop = Intervention::Velocity { body: BodyId(0), velocity: DVec2::ZERO, angular_velocity: 0.0 };
        assert_eq!(world.intervene(&[stop], &mut |_| ()), outcome);
        assert_eq!((world.advance_to(LATER, &mut |_| ()), world.time()), (Ok(()), LATER_STILL));
    }

    #[test]
    fn books_far_from_closing_end_the_advance_and_others_do_not() {
        // At a tolerance of 1e-8, of some 10 J.
        for (lost, is_astray) in [(1e-7, false), (1e-3, true)] {
            let mut world = pendulum();
            world.start.energy += lost;
            let outcome = world.advance_to(LATER_STILL, &mut |_| ());
            let found = matches!(outcome, Err(RunError::Astray { finding: Finding::OpenBooks { error, .. }, .. }) if (error - lost).abs() < 1e-6);
            assert_eq!(found, is_astray, "{lost}: {outcome:?}");
            assert_eq!(outcome.is_ok(), !is_astray);
        }
    }

    #[test]
    fn nothing_is_looked_at_while_next_to_nothing_happens() {
        let mut world = pendulum();
        world.start.energy += 1.0;
        let before = world.statistics().steps;
        assert!(world.monitor.is_sound, "it has just been looked at");
        world.advance_to(LATER + 1e-3, &mut |_| ()).expect("nobody looks");
        assert!(world.statistics().steps - before < SEGMENTS);
        assert!(!world.monitor.is_sound, "nobody knows");
    }

    /// A disc about to bounce off a floor, in a world where every speed that it reaches counts as slow.
    fn slow_disc() -> World {
        let overrides = ToleranceOverrides { velocity_tol: Some(10.0), ..ToleranceOverrides::default() };
        let settings = WorldSettings { overrides, duration: Some(1.0), ..WorldSettings::default() };
        let mut builder = WorldBuilder::new(settings);
        let [disc, floor] =
            [Shape::disc(0.5), Shape::block(10.0, 1.0)].map(|shape| shape.expect("a fine size"));
        let state = BodyState { position: DVec2::new(0.0, 1.5), ..BodyState::default() };
        let body = builder.add(BodySpec::movable("disc", disc, 1.0, state));
        builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
        builder.add_gravity(body, DVec2::new(0.0, -10.0));
        builder.build().expect("it falls")
    }

    #[test]
    fn blows_that_are_taken_for_slow_contacts_end_the_advance_unless_they_are_to_be() {
        let mut world = slow_disc();
        world.advance_to(1.0, &mut |_| ()).expect("the user wants it so");
        let mut world = slow_disc();
        world.monitor.slow_is_given = false;
        let outcome = world.advance_to(1.0, &mut |_| ());
        let Err(RunError::Astray { finding, .. }) = outcome else { panic!("{outcome:?}") };
        assert!(
            matches!(finding, Finding::Captured { energy, slow: 10.0, .. } if (energy - 10.0).abs() < 1e-6)
        );
    }

    #[test]
    fn a_block_that_bounces_by_less_than_the_gap_asked_for_comes_to_rest_however_often_it_is_looked_at() {
        let overrides = ToleranceOverrides {
            target_gap: Some(5e-3),
            accuracy: Some(3e-3),
            ..ToleranceOverrides::default()
        };
        let settings = WorldSettings { overrides, duration: Some(1.0), ..WorldSettings::default() };
        let mut builder = WorldBuilder::new(settings);
        let [block, floor] = [0.2, 10.0].map(|side| Shape::block(side, side).expect("a fine size"));
        let state = BodyState { position: DVec2::new(0.0, 0.11), ..BodyState::default() };
        let dropped = BodySpec { elasticity: 0.5, ..BodySpec::movable("block", block, 1.0, state) };
        let body = builder.add(dropped);
        builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -5.0)));
        builder.add_gravity(body, DVec2::new(0.0, -10.0));
        let mut world = builder.build().expect("it falls");
        for piece in 1..=400 {
            world.advance_to(f64::from(piece) / 400.0, &mut |_| ()).expect("it comes to rest");
        }
        assert!(world.ledger().captures < -1e-3, "{:?}", world.ledger());
    }

    #[test]
    fn blows_that_were_taken_for_slow_contacts_are_told_at_the_end_at_any_tolerance() {
        let mut world = slow_disc();
        world.advance_to(1.0, &mut |_| ()).expect("the user wants it so");
        let told = |world: &World| {
            world.findings(10.0).iter().any(|finding| matches!(finding, Finding::Captured { .. }))
        };
        assert!(!told(&world));
        world.monitor.slow_is_given = false;
        world.monitor.tolerance = 1e-2;
        assert!(world.books_astray(&Books::from(&world.ledger()), 10.0).is_none() && told(&world));
    }

    #[test]
    fn the_energy_turned_over_before_the_first_look_counts() {
        // The disc falls by 0.5 m and lies there: nothing moves at the time of a look.
        let mut world = slow_disc();
        world.start.energy += 1e-5;
        world.advance_to(1.0, &mut |_| ()).expect("so little of 5 J is rounding");
        assert!(world.monitor.turnover.energy > 4.9, "{:?}", world.monitor.turnover);
        assert!(world.energy().kinetic < 1e-12);
    }

    #[test]
    fn what_a_held_torque_does_within_the_tolerance_is_rounding_and_more_is_not() {
        // Dry friction holds a wheel against a spring, or against a motor: nothing moves.
        let (torque, tolerance): (f64, f64) = (4.0, 1e-8);
        let pinned = |on_pin: fn(ConnectorSpec, f64) -> ConnectorSpec, lost: f64| {
            let settings = WorldSettings { duration: Some(1.0), tolerance, ..WorldSettings::default() };
            let mut builder = WorldBuilder::new(settings);
            let shape = Shape::disc(0.5).expect("a fine radius");
            let body = builder.add(BodySpec::movable("wheel", shape, 1.0, BodyState::default()));
            let [a, b] = [BodyId::WORLD, body].map(|body| Anchor { body, point: DVec2::ZERO });
            let pin = Connector::new(ConnectorKind::Pin { a, b }, 0.0).expect("a fine pin");
            builder.add_connector(on_pin(ConnectorSpec::new(pin), torque).friction(2.0 * torque));
            let mut world = builder.build().expect("it stands");
            world.start.energy += lost;
            world.advance_to(1.0, &mut |_| ())
        };
        let spring = |pin: ConnectorSpec, torque: f64| {
            pin.spring(JointSpring { rest: 1.0, stiffness: torque, damping: 0.0 })
        };
        let motor = |pin: ConnectorSpec, torque: f64| pin.motor(Motor { speed: 1.0, max: torque });
        // Within the angle and far beyond it, in radians.
        for (angle, is_astray) in [(tolerance, false), (1e3 * tolerance, true)] {
            for on_pin in [spring, motor as fn(ConnectorSpec, f64) -> ConnectorSpec] {
                let outcome = pinned(on_pin, torque * angle);
                assert_eq!(outcome.is_err(), is_astray, "{angle} rad: {outcome:?}");
            }
        }
    }

    #[test]
    fn frequent_looks_are_strict() {
        // The usual energy here is some 10 J, but so far almost none of it is in play.
        for (first, is_astray) in [(0.02, true), (0.1, false)] {
            let mut world = slow_disc();
            world.advance_to(0.0, &mut |_| ()).expect("the first look");
            world.start.energy += 1e-5;
            let outcome = world.advance_to(first, &mut |_| ());
            assert_eq!(outcome.is_err(), is_astray, "{first}: {outcome:?}");
        }
    }
}
