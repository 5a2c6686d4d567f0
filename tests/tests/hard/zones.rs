//! Wide target zones, as scenes may ask for them.

use halfgap::geometry::DVec2;
use halfgap::scene::Scene;
use halfgap::{ToleranceOverrides, World, WorldSettings};
use halfgap_tests::data;
use halfgap_tests::mechanism::{Workshop, advance, at_rest, block, disc};

#[test]
fn a_disc_given_low_in_a_wide_zone_stays_there_by_impulses_alone_however_short_the_steps() {
    for accuracy in [4.5e-3, 3e-3] {
        for time_step in [2.5e-2, 5e-3, 1e-3, 5e-4] {
            for elasticity in [0.0, 0.3, 0.8] {
                let overrides = ToleranceOverrides {
                    target_gap: Some(5e-3),
                    accuracy: Some(accuracy),
                    velocity_tol: Some(0.5),
                };
                let time_step = Some(time_step);
                let mut shop = Workshop::of(WorldSettings {
                    overrides,
                    time_step,
                    contacts: false,
                    ..WorldSettings::default()
                });
                shop.fixed("floor", block(2.0, 0.5), DVec2::new(0.0, -0.25));
                let body = shop.settler("disc", disc(0.1), 1.0, at_rest(0.0, 0.104), elasticity);
                let mut world = shop.build();
                let (mut least, mut most) = (f64::INFINITY, 0.0f64);
                for piece in 1..=100 {
                    advance(&mut world, 0.01 * f64::from(piece));
                    let height = world.state(body).position.y - 0.1;
                    (least, most) = (least.min(height), most.max(height));
                }
                let what = format!("disc in a zone of {accuracy} m, {time_step:?} s, e = {elasticity}");
                assert!(least > 5e-3 - 1.5 * accuracy - 1e-3, "{what}: {least} m");
                assert!(most < 5e-3 + accuracy, "{what}: {most} m");
            }
        }
    }
}

#[test]
fn a_corner_beside_the_end_of_a_tooth_is_no_gap() {
    // Where a pin lets go of a tooth, the pin's corner is beside the tooth's end and far below the line of that end.
    let scene = Scene::read(data("music_box.json")).expect("a scene that can be read");
    let mut world = World::from_scene(&scene).expect("a world that can be built");
    advance(&mut world, 1.75);
    let nearest = world.statistics().smallest_gap.expect("they touch");
    assert!((3.9e-4..1.6e-3).contains(&nearest), "{nearest} m");
}
