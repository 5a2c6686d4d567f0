//! The reference scenes that free flight and impacts can reach.

use halfgap_tests::{check_at, reference_scene};

/// Scenes without contacts, connectors and forces other than gravity and damping.
const SCENES: [&str; 6] = [
    "exact__ball_bounce",
    "exact__two_discs_e1",
    "speed__ball_vs_wall_0",
    "speed__ball_vs_wall_1",
    "circle_straight__ball_block_collide",
    "straight_straight__corner_collision",
];

#[test]
fn reference_scenes_of_flight_and_impacts_are_reached() {
    for name in SCENES {
        let report = check_at(&reference_scene(name), None);
        assert!(report.ok, "{name}: {:?}", report.why);
    }
}

#[test]
fn exact_scenes_are_right_to_a_nanometre_at_a_tolerance_of_1e_10() {
    for name in ["exact__ball_bounce", "exact__two_discs_e1"] {
        let report = check_at(&reference_scene(name), Some(1e-10));
        let error = report.position_error.expect("positions are compared");
        assert!(report.ok && error < 1e-9, "{name}: {error} m");
    }
}

#[test]
fn errors_fall_with_the_tolerance() {
    let scene = reference_scene("exact__ball_bounce");
    let error = |tolerance| check_at(&scene, Some(tolerance)).position_error.expect("positions are compared");
    let errors = [1e-4, 1e-6, 1e-8, 1e-10].map(error);
    for pair in errors.windows(2) {
        let slope = (pair[0] / pair[1]).log10() / 2.0;
        assert!((0.8..=1.2).contains(&slope), "errors {errors:?}");
    }
}
