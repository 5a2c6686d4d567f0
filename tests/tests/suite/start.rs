//! Overlaps at the start are refused with bodies and depth; slow contacts at the start are caught.

use halfgap::geometry::DVec2;
use halfgap::scene::{Scene, SceneFormat};
use halfgap::{
    Anchor, BodyId, BodyState, ConnectorKind, Event, ToleranceOverrides, World, WorldBuilder, WorldSettings,
};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, connector_error, disc, thrown};
use halfgap_tests::{on_floor, world_of};

/// A builder of worlds in which contacts that close at less than 0.5 m/s are caught.
fn catching() -> WorldBuilder {
    let overrides = ToleranceOverrides { velocity_tol: Some(0.5), ..ToleranceOverrides::default() };
    WorldBuilder::new(WorldSettings { overrides, ..WorldSettings::default() })
}

fn build_error(toml: &str) -> String {
    let scene = Scene::parse(toml, SceneFormat::Toml).expect("a fine scene");
    World::from_scene(&scene).expect_err("refused").to_string()
}

#[test]
fn an_overlap_at_the_start_names_both_bodies_and_its_depth() {
    let message = build_error(&on_floor("shape = { disc = { radius = 0.5 } }\nposition = [0.0, 0.4]"));
    for part in ["\"floor\"", "\"body\"", "overlap by 0.1 m"] {
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn a_body_inside_another_overlaps_it() {
    let message = build_error(&on_floor("shape = { disc = { radius = 0.1 } }\nposition = [0.0, -0.5]"));
    assert!(message.contains("overlap by 0.5 m"), "{message}");
}

#[test]
fn a_tiny_overlap_is_lifted_to_the_target_gap() {
    let body = "shape = { disc = { radius = 0.5 } }\nposition = [0.0, 0.4999999]\nvelocity = [0.0, 3.0]";
    let world = world_of(&on_floor(body));
    let disc = world.find("body").expect("it is there");
    let gap = world.state(disc).position.y - 0.5;
    let target = world.tolerances().target_gap;
    assert!((gap - target).abs() < 1e-3 * target, "gap {gap}, target {target}");
    assert!(world.start_correction() > 1e-7);
}

#[test]
fn the_background_has_a_name_where_an_error_needs_one() {
    let world =
        halfgap_tests::world_of("format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = { duration = 1.0 }");
    assert_eq!(world.name(halfgap::BodyId::WORLD), "world");
}

#[test]
fn a_mass_whose_inverse_overflows_is_refused() {
    let scene = halfgap::scene::Scene::parse(
        "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = { duration = 1.0 }\n\
         [[body]]\nname = \"mote\"\nmass = 1e-309\nshape = { disc = { radius = 1.0 } }",
        halfgap::scene::SceneFormat::Toml,
    );
    let error = halfgap::World::from_scene(&scene.expect("it can be read")).expect_err("nothing is so light");
    assert!(error.to_string().contains("mote") && error.to_string().contains("inverse"), "{error}");
}

/// A ball on the floor at a velocity [m/s] upwards, in a scene in which half a metre per second is slow.
fn slow_ball(velocity: f64) -> World {
    let mut shop = Workshop::new(1e-8);
    shop.builder = catching();
    shop.fixed("floor", block(4.0, 1.0), DVec2::new(0.0, -0.5));
    shop.body("ball", disc(0.5), 2.0, thrown(0.0, 0.5, DVec2::new(1.0, velocity)));
    shop.build()
}

#[test]
fn a_ball_that_closes_slowly_at_the_start_is_caught_and_its_energy_booked() {
    for speed in [1e-3, 0.4] {
        let mut world = slow_ball(-speed);
        let ball = world.find("ball").expect("it is there");
        assert_eq!(world.state(ball).velocity, DVec2::new(1.0, 0.0));
        let height = world.state(ball).position.y;
        let forces = world.contact_forces();
        assert!(forces.len() == 1 && (forces[0].force - 20.0).abs() < 1e-12, "{forces:?}");
        advance(&mut world, 1.0);
        assert!((world.state(ball).position - DVec2::new(1.0, height)).length() < 1e-12);
        let ledger = world.ledger();
        assert!((ledger.captures + speed * speed).abs() < 1e-15, "{ledger:?}");
        assert!(ledger.projections.abs() < 1e-15 && ledger.integration_error().abs() < 1e-12, "{ledger:?}");
    }
}

#[test]
fn a_ball_that_departs_slowly_at_the_start_flies() {
    for speed in [1e-3, 0.4] {
        let mut world = slow_ball(speed);
        let ball = world.find("ball").expect("it is there");
        let (start, flight) = (world.state(ball), 2.0 * speed / GRAVITY);
        assert_eq!(start.velocity, DVec2::new(1.0, speed));
        assert!(world.contact_forces().is_empty(), "{:?}", world.contact_forces());
        advance(&mut world, 0.5 * flight);
        let rise = world.state(ball).position.y - start.position.y;
        assert!((rise - speed * speed / (2.0 * GRAVITY)).abs() < 1e-15, "it rises by {rise} m");
        let mut begins = Vec::new();
        world
            .advance_to(1.0, &mut |event| {
                begins.extend(matches!(event, Event::ContactBegins(_)).then(|| event.time()));
            })
            .expect("it comes down");
        assert!(begins.len() == 1 && (begins[0] - flight).abs() < 1e-9, "caught at {begins:?} s");
    }
}

#[test]
fn discs_that_meet_slowly_at_the_start_go_on_together() {
    let mut shop = Workshop::weightless(1e-8);
    shop.builder = catching();
    let slow = shop.body("slow", disc(0.5), 3.0, thrown(0.0, 0.0, DVec2::new(0.1, 0.0)));
    let fast = shop.body("fast", disc(0.5), 1.0, thrown(-1.0, 0.0, DVec2::new(0.5, 0.0)));
    let far = shop.body("far", disc(0.5), 1.0, thrown(5.0, 0.0, DVec2::new(0.4, 0.0)));
    let world = shop.build();
    for body in [slow, fast] {
        assert!(
            (world.state(body).velocity - DVec2::new(0.2, 0.0)).length() < 1e-15,
            "{:?}",
            world.state(body)
        );
    }
    assert_eq!(world.state(far).velocity, DVec2::new(0.4, 0.0));
    // The reduced mass is 3/4 kg.
    assert!((world.ledger().captures + 0.5 * 0.75 * 0.4 * 0.4).abs() < 1e-15, "{:?}", world.ledger());
}

#[test]
fn a_disc_that_closes_fast_at_the_start_bounces_beside_one_that_is_caught() {
    let mut shop = Workshop::new(1e-8);
    shop.builder = catching();
    shop.fixed("floor", block(9.0, 1.0), DVec2::new(0.0, -0.5));
    let slow = shop.body("slow", disc(0.5), 2.0, thrown(-2.0, 0.5, DVec2::new(0.0, -0.4)));
    let fast = shop.body("fast", disc(0.5), 2.0, thrown(2.0, 0.5, DVec2::new(0.0, -2.0)));
    let mut world = shop.build();
    let start = world.state(fast).position.y;
    advance(&mut world, 0.2);
    assert_eq!(world.state(slow).velocity, DVec2::ZERO);
    // The disc goes up at 2 m/s for 0.2 s, with gravity against it.
    let rise = world.state(fast).position.y - start;
    assert!((rise - 0.2).abs() < 1e-9, "{rise} m");
}

#[test]
fn a_wheel_on_a_fixed_axle_that_just_touches_its_floor_turns() {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(9.0, 1.0), DVec2::new(0.0, -0.5));
    let turning = BodyState { angular_velocity: 3.0, ..at_rest(0.0, 0.5) };
    let wheel = shop.body("wheel", disc(0.5), 2.0, turning);
    shop.pin(wheel, BodyId::WORLD, DVec2::new(0.0, 0.5));
    let loose = shop.body("loose", disc(0.5), 2.0, at_rest(2.0, 0.5));
    let mut world = shop.build();
    let target = world.tolerances().target_gap;
    advance(&mut world, 2.0);
    let state = world.state(wheel);
    assert!((state.position - DVec2::new(0.0, 0.5)).length() < 1e-12, "{state:?}");
    assert!((state.angle - 6.0).abs() < 1e-12 && (state.angular_velocity - 3.0).abs() < 1e-15, "{state:?}");
    // Bodies that can be lifted are.
    assert!((world.state(loose).position.y - 0.5 - target).abs() < 0.7 * target);
}

#[test]
fn a_block_that_just_fits_between_two_walls_slides_along_them() {
    let mut shop = Workshop::weightless(1e-8);
    for (name, x) in [("left", -1.0), ("right", 1.0)] {
        shop.fixed(name, block(1.0, 9.0), DVec2::new(x, 0.0));
    }
    let slider = shop.body("slider", block(1.0, 0.5), 2.0, thrown(0.0, 0.0, DVec2::new(0.0, 0.3)));
    let mut world = shop.build();
    advance(&mut world, 2.0);
    let state = world.state(slider);
    assert!(
        (state.position - DVec2::new(0.0, 0.6)).length() < 1e-12 && state.angle.abs() < 1e-12,
        "{state:?}"
    );
}

#[test]
fn a_ball_bounces_before_time_zero_as_it_does_after() {
    for start in [0.0, -500.0] {
        let text = on_floor("shape = { disc = { radius = 0.5 } }\nposition = [0.0, 1.0]");
        let mut scene = Scene::parse(&text, SceneFormat::Toml).expect("a fine scene");
        scene.run.start_time = start;
        let mut world = World::from_scene(&scene).expect("a world that can be built");
        let energy = world.energy().total();
        advance(&mut world, start + 40.0);
        assert!(world.statistics().impacts > 50, "{:?}", world.statistics());
        assert!((world.energy().total() - energy).abs() < 1e-9, "{:?}", world.ledger());
    }
}

#[test]
fn pins_that_contradict_each_other_by_less_than_the_tolerance_start_as_they_are() {
    // Two discs on two pins, the second of which lies a little farther off on one of them.
    for off in [1e-13, 1e-12, 1e-11, 1e-10] {
        let mut shop = Workshop::new(1e-6);
        let first = shop.body("first", disc(0.5), 3.0, thrown(0.0, 0.0, DVec2::new(1.0, 0.3)));
        let second = shop.body("second", disc(0.5), 0.2, thrown(2.0, 0.5, DVec2::new(1.0, 0.3)));
        for (place, off) in [(DVec2::new(0.7, -0.4), 0.0), (DVec2::new(-0.2, 0.9), off)] {
            let a = shop.anchor(second, place);
            let b = Anchor { point: place + DVec2::new(off, 0.0), ..shop.anchor(first, place) };
            shop.connect(ConnectorKind::Pin { a, b }, 0.0);
        }
        let mut world = shop.builder.build().unwrap_or_else(|error| panic!("{off:e} m off: {error}"));
        advance(&mut world, 1.0);
        let error = connector_error(&world);
        assert!(error < 2.0 * off, "{off:e} m off: {error:e} m");
    }
}
