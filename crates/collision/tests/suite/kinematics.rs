//! Rate, Jacobian and gamma of every kind of feature pair against finite differences of the gap itself.

use crate::differences::{first, second};
use crate::pairs::{Case, any_case, round};
use crate::path::Path;
use glam::DVec2;
use halfgap_collision::BodyAcceleration;
use proptest::prelude::*;

/// Promised accuracy of the kinematics, relative to the scale of the terms.
const PROMISE: f64 = 1e-6;
/// Tolerance of the differences below. The formulas are exact, so this is the bound that is asserted.
const DIFFERENCE: f64 = 1e-8;
/// Steps [s] of the differences, at which rounding and truncation stay below the tolerance: order 8, h^8 against
/// eps/h^2.
const STEP: f64 = 0.004;

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
