//! Tangential rows and their coordinates, of every kind of feature pair, against finite differences.

use crate::differences::first;
use crate::pairs::{Case, KINDS, case_of_kind};
use crate::path::Path;
use glam::DVec2;
use halfgap_collision::{
    BodyAcceleration, BodyId, Collision, Detector, GapKinematics, Moving, Participant, Parties, TangentRow,
    Tolerances, Touch, turned,
};
use halfgap_geometry::Feature;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

/// Tolerance of the differences below, relative to the scale of the terms; the formulas are exact.
const DIFFERENCE: f64 = 1e-9;
/// Step [s] of the differences, at which rounding and truncation stay below the tolerance.
const STEP: f64 = 0.004;
/// Random pairs of each kind.
const CASES: u32 = 10_000;

impl Case {
    /// Signed radii of the primary and the normal feature; `None` for a line.
    fn radii(&self) -> [Option<f64>; 2] {
        let [a, b] = self.features.map(|feature| match feature {
            Feature::Round(round) => Some(round.radius),
            Feature::Line(_) => None,
        });
        if self.sample(0.0).primary_is_a { [a, b] } else { [b, a] }
    }

    /// What `read` makes of the features at a time, with the gap of time 0 as the one that is kept.
    fn touch<T>(&self, t: f64, read: impl FnOnce(&Touch<'_>) -> T) -> T {
        let (sample, moments) = (self.sample(t), self.sides().map(|path| path.at(t)));
        let kept_gap = self.sample(0.0).gap;
        read(&Touch { sample: &sample, radii: self.radii(), bodies: [&moments[0], &moments[1]], kept_gap })
    }

    fn row(&self, t: f64, surface_speeds: [f64; 2]) -> TangentRow {
        let [primary, normal] = self.sides().map(|path| path.at(t));
        let kinematics = GapKinematics::of(&self.sample(t), &primary, &normal);
        self.touch(t, |touch| TangentRow::of(touch, &kinematics, surface_speeds))
    }

    /// The coordinate less the way of the surfaces.
    fn coordinate(&self, t: f64, surface_speeds: [f64; 2]) -> f64 {
        let angle = |t| turned(self.sample(t).normal, self.sample(0.0).normal.to_angle());
        self.touch(t, |touch| touch.coordinate(angle(t))) - (surface_speeds[0] + surface_speeds[1]) * t
    }

    /// The motion in which only velocity `k` of six is not 0.
    fn alone(&self, k: usize) -> Case {
        let still =
            |path: Path| Path { velocity: DVec2::ZERO, spin: 0.0, push: BodyAcceleration::default(), ..path };
        let [mut primary, mut normal] = self.sides().map(still);
        let moved = if k < 3 { &mut primary } else { &mut normal };
        match k % 3 {
            0 => moved.velocity.x = 1.0,
            1 => moved.velocity.y = 1.0,
            _ => moved.spin = 1.0,
        }
        let paths = if self.sample(0.0).primary_is_a { [primary, normal] } else { [normal, primary] };
        Case { paths, ..*self }
    }
}

/// Checks `check` on many cases of every kind, with surfaces that run.
fn for_all(check: impl Fn(&Case, [f64; 2]) -> Result<(), TestCaseError>) {
    for kind in 0..KINDS {
        let config = ProptestConfig { cases: CASES, failure_persistence: None, ..ProptestConfig::default() };
        let cases = (case_of_kind(kind), prop::array::uniform2(-2.0..2.0f64));
        let outcome =
            TestRunner::new(config).run(&cases, |(case, surface_speeds)| check(&case, surface_speeds));
        outcome.unwrap_or_else(|failure| panic!("pairs of kind {kind}: {failure}"));
    }
}

#[test]
fn the_slip_speed_is_the_derivative_of_the_coordinate() {
    for_all(|case, surface_speeds| {
        let difference = first(|t| case.coordinate(t, surface_speeds), STEP);
        let found = case.row(0.0, surface_speeds).rate;
        prop_assert!((found - difference).abs() <= DIFFERENCE * case.scales()[0].max(1.0));
        Ok(())
    });
}

#[test]
fn the_jacobian_is_the_derivative_of_the_coordinate_by_each_position() {
    for_all(|case, _| {
        let row = case.row(0.0, [0.0; 2]);
        for k in 0..6 {
            let alone = case.alone(k);
            let difference = first(|t| alone.coordinate(t, [0.0; 2]), STEP);
            let scale = alone.scales()[0].max(1.0);
            prop_assert!((row.jacobian[k] - difference).abs() <= DIFFERENCE * scale, "entry {}", k);
            prop_assert!((row.jacobian[k] - alone.row(0.0, [0.0; 2]).rate).abs() <= 1e-14 * scale);
        }
        Ok(())
    });
}

#[test]
fn the_acceleration_is_the_derivative_of_the_slip_speed() {
    for_all(|case, surface_speeds| {
        let [primary, normal] = case.sides();
        let difference = first(|t| case.row(t, surface_speeds).rate, STEP);
        let found = case.row(0.0, surface_speeds).acceleration(&primary.push, &normal.push);
        prop_assert!((found - difference).abs() <= DIFFERENCE * case.scales()[1].max(1.0));
        Ok(())
    });
}

#[test]
fn opposite_forces_at_the_touching_points_turn_nothing() {
    for_all(|case, _| {
        let [p, q] = case.touch(0.0, |touch| touch.points());
        prop_assert!((p - q).length() <= 1e-14 * (1.0 + p.length()));
        // The moments of both forces about the origin of the world cancel.
        let row = case.row(0.0, [0.0; 2]).jacobian;
        let moment = |k: usize, at: DVec2| at.perp_dot(DVec2::new(row[k], row[k + 1])) + row[k + 2];
        let [a, b] = case.sides().map(|path| path.position);
        prop_assert!((moment(0, a) + moment(3, b)).abs() <= 1e-13 * (1.0 + a.length() + b.length()));
        Ok(())
    });
}

#[test]
fn the_record_has_the_tangent_and_the_slip_of_the_row() {
    let tolerances = Tolerances { target_gap: 0.0, accuracy: 0.0, velocity_tol: 0.0 };
    for_all(|case, _| {
        let moments: [Moving; 2] = case.sides().map(|path| path.at(0.0));
        let bodies = [&moments[0], &moments[1]];
        let side = |id| Participant { body: BodyId(id), site: None };
        let (primary, normal) = (side(0), side(1));
        let parties =
            Parties { primary, normal, third: None, bilateral: false, detector: Detector::EdgeEdge };
        let (sample, radii) = (case.sample(0.0), case.radii());
        let record = Collision::new(parties, (&sample, radii), bodies, tolerances, 1.0, 0.0);
        // The record measures slip at the two points of the outlines, as if no gap were kept between them.
        let touch = Touch { sample: &sample, radii, bodies, kept_gap: 0.0 };
        let row = TangentRow::of(&touch, &record.motion.kinematics, [0.0; 2]);
        let scale = case.scales()[0].max(1.0);
        prop_assert!((record.motion.lateral_velocity - row.rate).abs() <= 1e-13 * scale);
        let tangent = record.geometry.tangent();
        prop_assert_eq!([row.jacobian[0], row.jacobian[1]], [tangent.x, tangent.y]);
        Ok(())
    });
}
