//! Rate, Jacobian and gamma of every kind of feature pair against finite differences of the gap itself.

use crate::differences::{first, second};
use crate::path::{Path, any_path, any_vector};
use glam::DVec2;
use halfgap_collision::{Arms, BodyAcceleration, GapKinematics};
use halfgap_geometry::{DirectionRange, Feature, GapSample, LineFeature, RoundFeature};
use proptest::prelude::*;

/// Promised accuracy of the kinematics, relative to the scale of the terms.
const PROMISE: f64 = 1e-6;
/// Tolerance of the differences below. The formulas are exact, so this is the bound that is asserted.
const DIFFERENCE: f64 = 1e-8;
/// Steps [s] of the differences, at which rounding and truncation stay below the tolerance: order 8, h^8 against
/// eps/h^2.
const STEP: f64 = 0.004;

/// Two features and the paths of their bodies.
#[derive(Clone, Copy, Debug)]
struct Case {
    features: [Feature; 2],
    paths: [Path; 2],
}

impl Case {
    fn sample(&self, t: f64) -> GapSample {
        let [a, b] = self.paths.map(|path| path.at(t).pose);
        GapSample::measure(&self.features[0], &a, &self.features[1], &b).expect("a pair that can touch")
    }

    /// The primary side and the normal side.
    fn sides(&self) -> [Path; 2] {
        let [a, b] = self.paths;
        if self.sample(0.0).primary_is_a { [a, b] } else { [b, a] }
    }

    fn kinematics(&self) -> GapKinematics {
        let [primary, normal] = self.sides().map(|path| path.at(0.0));
        GapKinematics::of(&self.sample(0.0), &primary, &normal)
    }

    /// Size of the terms of which rate and acceleration are sums: [m/s] and [m/s^2].
    fn scales(&self) -> [f64; 2] {
        let sample = self.sample(0.0);
        let [primary, normal] = self.sides();
        let moments = [primary.at(0.0), normal.at(0.0)];
        let arms = Arms::of(&sample, &moments[0], &moments[1]);
        let (mut speed, mut push) = (0.0, 0.0);
        for (path, arm) in [(primary, arms.primary), (normal, arms.normal)] {
            speed += path.velocity.length() + path.spin.abs() * arm.length();
            push += path.push.linear.length() + (path.push.angular.abs() + path.spin.powi(2)) * arm.length();
        }
        let distance = (sample.center_primary - sample.center_normal).length();
        [speed, push + speed * (normal.spin.abs() + speed / distance)]
    }
}

fn round(center: DVec2, radius: f64) -> Feature {
    Feature::Round(RoundFeature { center, radius, range: DirectionRange::Full })
}

fn line(angle: f64, offset: f64) -> Feature {
    let normal = DVec2::from_angle(angle);
    Feature::Line(LineFeature { normal, direction: normal.perp(), offset, start: -1.0, end: 1.0 })
}

/// The seven kinds of pairs; the numbers give the places of the features in their bodies.
fn features(kind: usize, centers: [DVec2; 2], [small, size, angle]: [f64; 3]) -> [Feature; 2] {
    let [a, b] = centers;
    match kind {
        0 => [round(a, 0.0), round(b, 0.0)],
        1 => [round(a, 0.0), round(b, size)],
        2 => [round(a, 0.0), round(b, -size)],
        3 => [round(a, small), round(b, size)],
        4 => [round(a, small), round(b, -size)],
        5 => [round(a, 0.0), line(angle, size)],
        _ => [round(a, small), line(angle, size)],
    }
}

fn any_case() -> impl Strategy<Value = Case> {
    let numbers = [0.1..0.5f64, 0.6..2.0f64, -3.2..3.2f64];
    let centers = prop::array::uniform2(any_vector(1.0));
    let case = (0..7usize, centers, numbers, prop::array::uniform2(any_path()), any::<bool>());
    case.prop_map(|(kind, centers, numbers, mut paths, swapped)| {
        let mut features = features(kind, centers, numbers);
        if swapped {
            features.reverse();
            paths.reverse();
        }
        Case { features, paths }
    })
    // Where centres meet the gap has a corner, and differences across it mean nothing.
    .prop_filter("the centres keep apart", |case| {
        let sample = case.sample(0.0);
        (sample.center_primary - sample.center_normal).length() > 0.8
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_rate_is_the_derivative_of_the_gap(case in any_case()) {
        let difference = first(|t| case.sample(t).gap, STEP);
        prop_assert!((case.kinematics().rate - difference).abs() <= DIFFERENCE * case.scales()[0].max(1.0));
    }

    #[test]
    fn the_jacobian_is_the_derivative_of_the_rate_by_each_velocity(case in any_case()) {
        let kinematics = case.kinematics();
        for k in 0..6 {
            // The gap along the motion in which only velocity k is not 0: its rate is J_k.
            let [mut primary, mut normal] = case.sides().map(|path| Path {
                velocity: DVec2::ZERO,
                spin: 0.0,
                push: BodyAcceleration::default(),
                ..path
            });
            let moved = if k < 3 { &mut primary } else { &mut normal };
            match k % 3 {
                0 => moved.velocity.x = 1.0,
                1 => moved.velocity.y = 1.0,
                _ => moved.spin = 1.0,
            }
            let paths = if case.sample(0.0).primary_is_a { [primary, normal] } else { [normal, primary] };
            let alone = Case { paths, ..case };
            let difference = first(|t| alone.sample(t).gap, STEP);
            let scale = alone.scales()[0].max(1.0);
            prop_assert!((kinematics.jacobian[k] - difference).abs() <= DIFFERENCE * scale, "entry {}", k);
            prop_assert!((kinematics.jacobian[k] - alone.kinematics().rate).abs() <= 1e-14 * scale);
        }
    }

    #[test]
    fn the_rate_is_the_jacobian_times_the_velocities(case in any_case()) {
        let [a, b] = case.sides();
        let velocities = [a.velocity.x, a.velocity.y, a.spin, b.velocity.x, b.velocity.y, b.spin];
        let kinematics = case.kinematics();
        let product: f64 = (0..6).map(|k| kinematics.jacobian[k] * velocities[k]).sum();
        prop_assert!((kinematics.rate - product).abs() <= 1e-14 * case.scales()[0]);
    }

    #[test]
    fn the_acceleration_is_the_second_derivative_of_the_gap(case in any_case()) {
        let [primary, normal] = case.sides();
        let difference = second(|t| case.sample(t).gap, STEP);
        let found = case.kinematics().acceleration(&primary.push, &normal.push);
        let scale = case.scales()[1].max(1.0);
        prop_assert!((found - difference).abs() <= DIFFERENCE * scale, "{} against {}", found, difference);
        // Without accelerations the acceleration of the gap is gamma.
        prop_assert_eq!(case.kinematics().acceleration(&BodyAcceleration::default(), &BodyAcceleration::default()), case.kinematics().gamma);
    }

    #[test]
    fn the_normal_rate_is_the_derivative_of_the_normal(case in any_case()) {
        let difference = first(|t| case.sample(t).normal, STEP);
        let scale = case.scales()[0].max(1.0);
        prop_assert!((case.kinematics().normal_rate - difference).length() <= DIFFERENCE * scale);
    }
}

#[test]
fn the_differences_are_sharper_than_the_promise() {
    const { assert!(DIFFERENCE < 0.1 * PROMISE) };
    let wave = |t: f64| (0.3 + 2.0 * t).sin();
    assert!((first(wave, STEP) - 2.0 * 0.3f64.cos()).abs() < 1e-11);
    assert!((second(wave, STEP) + 4.0 * 0.3f64.sin()).abs() < 1e-9);
}

#[test]
fn a_disc_rolling_inside_a_ring_accelerates_towards_its_wall() {
    // A centre at distance 1 from that of a hollow of radius 2, passing at 3 m/s: the gap closes with u^2/|d|.
    let features = [round(DVec2::ZERO, 0.5), round(DVec2::ZERO, -2.0)];
    let still = Path {
        position: DVec2::ZERO,
        angle: 0.0,
        velocity: DVec2::ZERO,
        spin: 0.0,
        push: BodyAcceleration::default(),
    };
    let mover = Path { position: DVec2::X, velocity: DVec2::new(0.0, 3.0), spin: 7.0, ..still };
    let kinematics = Case { features, paths: [mover, still] }.kinematics();
    assert_eq!((kinematics.rate, kinematics.gamma), (0.0, -9.0));
    assert_eq!(kinematics.normal_rate, DVec2::new(0.0, -3.0));
}
