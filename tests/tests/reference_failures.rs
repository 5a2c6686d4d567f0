//! Scenes at which the reference engine fails, gets stuck or takes very long.

use halfgap::World;
use halfgap::scene::Scene;
use halfgap_tests::mechanism::advance;
use halfgap_tests::reference_scene;

fn world(scene: &Scene) -> World {
    World::from_scene(scene).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_gears_turn_for_a_minute() {
    let mut scene = reference_scene("apps__gears");
    scene.set_duration(60.0, "duration").expect("a fine duration");
    let mut world = world(&scene);
    let turned = |world: &World, name: &str| world.state(world.find(name).expect("it is there")).angle;
    for second in 1..=60 {
        advance(&mut world, f64::from(second));
        // Teeth mesh: what one turns the other turns back, but for the play between teeth.
        let (left, right) = (turned(&world, "left_gear"), turned(&world, "right_gear"));
        assert!((left + right).abs() < 0.1, "{left} and {right} at {second} s");
    }
    println!("gears: {:?}", world.statistics());
    assert!(turned(&world, "left_gear").abs() > 10.0);
}

/// A ball that bounces until it rests, by impulses alone.
#[test]
fn a_ball_comes_to_rest_by_impulses_alone() {
    let scene = "format = \"halfgap-scene-1\"\ntitle = \"bounces\"\nrun = { duration = 30.0, contacts = false }\n\
        force = [{ gravity = { acceleration = [0.0, -10.0] } }]\n\
        [[body]]\nname = \"floor\"\nfixed = true\nshape = { block = { width = 20.0, height = 1.0 } }\nposition = [0.0, -0.5]\n\
        [[body]]\nname = \"ball\"\nmass = 1.0\nshape = { disc = { radius = 0.5 } }\nposition = [0.0, 3.0]\nelasticity = 0.8\n";
    let mut world = halfgap_tests::world_of(scene);
    advance(&mut world, 30.0);
    let ball = world.find("ball").expect("it is there");
    let gap = world.state(ball).position.y - 0.5;
    assert!(gap > 0.0 && gap < 0.01, "{gap} m over the floor");
}
