//! The scenes: a file each, with how its answer is known.

mod billiards;
mod cam;
mod chain;
mod convex_arc;
mod exact;
mod four_bar;
mod friction;
mod geneva;
mod impacts;
mod joint_friction;
mod limits;
mod motors;
pub mod piles;
mod rail;
mod rod;
mod slider_crank;

use crate::scene::Scene;

/// How a scene is made: its name is known before, as its answer may take a while.
type Maker = (&'static str, fn() -> Scene);

/// All scenes, in the order of the report: impacts, mechanisms, contacts, friction, motors and limits, and piles of which
/// only the time is measured.
const MAKERS: [Maker; 38] = [
    ("ball_bounce", || exact::read("ball_bounce", 0.05)),
    ("bounce_to_rest", impacts::to_rest),
    ("two_discs_e1", || exact::read("two_discs_e1", 0.5)),
    ("oblique_discs", impacts::oblique),
    ("newtons_cradle", || exact::read("newtons_cradle", 0.5)),
    ("square_billiard", billiards::square),
    ("sinai_billiard", billiards::sinai),
    ("stadium_billiard", billiards::stadium),
    ("pendulum", || exact::read("pendulum", 0.5)),
    ("double_pendulum", || exact::read("double_pendulum", 0.5)),
    ("four_bar", four_bar::scene),
    ("falling_chain", chain::scene),
    ("disc_in_bowl", || exact::read("disc_in_bowl", 0.5)),
    ("disc_off_hill", convex_arc::scene),
    ("cam_and_roller", cam::scene),
    ("geneva_drive", geneva::scene),
    ("brachistochrone", rail::scene),
    ("block_slide_friction", || exact::read("block_slide_friction", 0.25)),
    ("disc_slips_then_rolls", || friction::without_bounce("disc_slips_then_rolls", 0.25)),
    ("disc_rolls_in_bowl", || friction::without_bounce("disc_rolls_in_bowl", 0.1)),
    ("disc_bounces_sliding", || friction::read("disc_bounces_sliding", 0.1)),
    ("block_rocks", || friction::read("block_rocks", 0.2)),
    ("belt_stick_slip", friction::belt),
    ("friction_drive", || friction::without_bounce("friction_drive", 0.1)),
    ("ladder_rests", || friction::without_bounce("ladder_rests", 1.0)),
    ("stack_10", || friction::at_rest("stack_10", 1.0)),
    ("pyramid_20", || friction::at_rest("pyramid_20", 1.0)),
    ("motor_spins_up", motors::spins_up),
    ("motor_turns_arm", motors::turns_arm),
    ("lift_to_stop", motors::lift_to_stop),
    ("pendulum_on_limits", limits::pendulum),
    ("knee_on_limit", limits::knee),
    ("joint_friction_stops", joint_friction::scene),
    ("driven_four_bar", four_bar::driven),
    ("driven_slider_crank", slider_crank::driven),
    ("driven_geneva", geneva::driven),
    ("settling_discs", piles::discs),
    ("stack_of_boxes", piles::stack),
];

/// The scenes whose name is wanted.
#[must_use]
pub fn wanted(is_wanted: impl Fn(&str) -> bool) -> Vec<Scene> {
    MAKERS.iter().filter(|(name, _)| is_wanted(name)).map(|(_, make)| make()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_have_the_names_they_are_listed_by_and_errors_that_are_stated() {
        for (name, make) in MAKERS {
            let scene = make();
            assert_eq!(scene.name, name);
            assert!(scene.duration > 0.0 && scene.check_grid > 0.0, "{name}");
            let on_grid =
                |time: f64| (time / scene.check_grid - (time / scene.check_grid).round()).abs() < 1e-9;
            assert!(scene.checks.iter().all(|check| on_grid(check.time)), "{name}");
            let is_stated = scene.reference_error > 0.0 && scene.reference_error < 1e-10;
            assert!(!scene.has_answer() || is_stated, "{name}: {}", scene.reference_error);
        }
    }
}
