//! The scenes: a file each, with how its answer is known.

mod billiards;
mod cam;
mod chain;
mod convex_arc;
mod exact;
mod four_bar;
mod impacts;
mod piles;
mod rail;

use crate::scene::Scene;

/// All scenes, in the order of the report: impacts, mechanisms, contacts, and piles of which only the time is measured.
#[must_use]
pub fn all() -> Vec<Scene> {
    let mut scenes = exact::scenes();
    let own = [impacts::oblique, impacts::to_rest, billiards::square, billiards::sinai, billiards::stadium];
    scenes.extend(own.map(|scene| scene()));
    let own = [four_bar::scene, chain::scene, convex_arc::scene, rail::scene, cam::scene];
    scenes.extend(own.map(|scene| scene()));
    scenes.extend([piles::discs(), piles::stack()]);
    scenes
}
