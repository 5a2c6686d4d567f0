//! The scenes: a file each, with how its answer is known.

mod billiards;
mod cam;
mod chain;
mod convex_arc;
mod exact;
mod four_bar;
mod geneva;
mod impacts;
pub mod piles;
mod rail;

use crate::scene::Scene;

/// How a scene is made: its name is known before, as its answer may take a while.
type Maker = (&'static str, fn() -> Scene);

/// All scenes, in the order of the report: impacts, mechanisms, contacts, and piles of which only the time is measured.
const MAKERS: [Maker; 19] = [
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
