//! Corrections before the start of a world: connectors put together, velocities made to fit, gaps lifted.

use halfgap::geometry::{DVec2, Shape};
use halfgap::{
    Anchor, BodyId, BodySpec, BodyState, Connector, ConnectorId, ConnectorKind, ConnectorSpec, Integrator,
    ToleranceOverrides, World, WorldBuilder, WorldError, WorldSettings,
};

fn disc(name: &str, mass: f64, position: DVec2) -> BodySpec {
    let state = BodyState { position, ..BodyState::default() };
    BodySpec::movable(name, Shape::disc(0.5).expect("a fine radius"), mass, state)
}

fn center(body: BodyId) -> Anchor {
    Anchor { body, point: DVec2::ZERO }
}

fn at(x: f64, y: f64) -> Anchor {
    Anchor { body: BodyId::WORLD, point: DVec2::new(x, y) }
}

fn spec(kind: ConnectorKind) -> ConnectorSpec {
    ConnectorSpec::new(Connector::new(kind, 0.0).expect("a fine connector"))
}

fn pin(a: Anchor, b: Anchor) -> ConnectorSpec {
    spec(ConnectorKind::Pin { a, b })
}

fn rod(a: Anchor, b: Anchor, length: f64) -> ConnectorSpec {
    spec(ConnectorKind::Rod { a, b, length })
}

fn build(builder: WorldBuilder) -> World {
    builder.build().unwrap_or_else(|error| panic!("{error}"))
}

fn largest_error(world: &World, connectors: &[ConnectorId]) -> f64 {
    connectors.iter().map(|&one| world.connector_error(one)).fold(0.0, f64::max)
}

#[test]
fn a_pin_that_is_a_little_off_is_put_together_by_the_lighter_body() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let light = builder.add(disc("light", 1.0, DVec2::ZERO));
    let heavy = builder.add(disc("heavy", 3.0, DVec2::new(0.0, 4e-7)));
    let joint = builder.add_connector(pin(center(light), center(heavy)));
    let world = build(builder);
    assert!((world.state(light).position.y - 3e-7).abs() < 1e-20, "{}", world.state(light).position);
    assert!((world.state(heavy).position.y - 3e-7).abs() < 1e-20);
    assert!((world.start_correction() - 3e-7).abs() < 1e-20);
    assert!(world.connector_error(joint) < 1e-20);
}

#[test]
fn a_bob_that_fits_its_rod_is_not_moved() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let place = DVec2::new(0.1, 0.7);
    let bob = builder.add(disc("bob", 1.0, place));
    builder.add_connector(rod(at(0.4, 1.1), center(bob), 0.5));
    let world = build(builder);
    assert_eq!(world.start_correction(), 0.0);
    // The state is read from a segment, which has the rounding of its motion.
    let off = (world.state(bob).position - place).length();
    assert!(off < 1e-15, "off by {off} m");
}

#[test]
fn larger_errors_are_refused_by_name() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let bob = builder.add(disc("bob", 1.0, DVec2::new(0.0, 2.0)));
    builder.add_connector(rod(at(0.0, 0.0), center(bob), 2.0));
    builder.add_connector(rod(at(0.0, 4.0), center(bob), 1.875));
    let error = builder.clone().build().expect_err("an eighth of a metre is too much");
    assert_eq!(
        error.to_string(),
        "connector 1 (rod of \"world\" and \"bob\") is off by 0.125 m at the start; at most 5e-7 m are allowed"
    );
    let error = {
        let mut builder =
            WorldBuilder::new(WorldSettings { start_connector_error: Some(0.2), ..WorldSettings::default() });
        let bob = builder.add(disc("bob", 1.0, DVec2::new(0.0, 2.0)));
        builder.add_connector(rod(at(0.0, 0.0), center(bob), 2.0));
        builder.add_connector(rod(at(0.0, 4.0), center(bob), 1.875));
        builder.build().expect_err("two rods cannot span 4 m with 3.875 m")
    };
    assert!(matches!(error, WorldError::CannotConnect { .. }), "{error}");
}

#[test]
fn a_body_that_is_many_times_its_size_off_is_put_together() {
    let settings = WorldSettings { start_connector_error: Some(0.5), ..WorldSettings::default() };
    let mut builder = WorldBuilder::new(settings);
    let state = BodyState { position: DVec2::new(0.3, 2.25), ..BodyState::default() };
    let bead = builder.add(BodySpec::movable("bead", Shape::disc(0.01).expect("a fine radius"), 1.0, state));
    let joint = builder.add_connector(rod(at(0.0, 0.0), center(bead), 2.0));
    let world = build(builder);
    assert!(world.connector_error(joint) < 1e-14, "{}", world.connector_error(joint));
}

#[test]
fn connectors_are_no_farther_apart_for_a_coarse_zone() {
    // Two rods that are 50 micrometres too short for their ends, in a world where bodies touch within millimetres.
    let overrides =
        ToleranceOverrides { target_gap: Some(5e-3), accuracy: Some(3e-3), ..ToleranceOverrides::default() };
    let settings = WorldSettings { start_connector_error: Some(0.2), overrides, ..WorldSettings::default() };
    let mut builder = WorldBuilder::new(settings);
    let bob = builder.add(disc("bob", 1.0, DVec2::new(0.0, 2.0)));
    builder.add_connector(rod(at(0.0, 0.0), center(bob), 2.0));
    builder.add_connector(rod(at(0.0, 4.0), center(bob), 1.99995));
    let error = builder.build().expect_err("two rods cannot span 4 m with 3.99995 m");
    assert!(matches!(error, WorldError::CannotConnect { .. }), "{error}");
}

#[test]
fn steps_that_are_too_long_for_damping_are_told_of() {
    let warnings = |integrator: Integrator, time_step: f64| {
        let settings = WorldSettings { integrator, time_step: Some(time_step), ..WorldSettings::default() };
        let mut builder = WorldBuilder::new(settings);
        let bob = builder.add(disc("bob", 2.0, DVec2::ZERO));
        builder.add_damping(bob, 160.0, 0.0);
        builder.build().expect("a damped disc").warnings().to_vec()
    };
    assert_eq!(warnings(Integrator::Euler, 0.0125), Vec::<String>::new());
    assert_eq!(warnings(Integrator::Dop853, 1.0), Vec::<String>::new());
    assert_eq!(
        warnings(Integrator::ModifiedEuler, 0.05),
        [
            "a `time_step` of 0.05 s is too long for body \"bob\", damped at 80 1/s: while it is tied or in contact, its \
             motion grows instead of decaying in steps of more than 0.025 s"
        ]
    );
}

#[test]
fn velocities_that_pull_a_rod_apart_are_changed_and_told_of() {
    let warnings = |speed: f64| {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        let (position, velocity) = (DVec2::new(0.0, 2.0), DVec2::new(1.0, speed));
        let state = BodyState { position, velocity, ..BodyState::default() };
        let shape = Shape::disc(0.5).expect("a fine radius");
        let bob = builder.add(BodySpec::movable("bob", shape, 1.0, state));
        builder.add_connector(rod(at(0.0, 0.0), center(bob), 2.0));
        let world = build(builder);
        assert!((world.state(bob).velocity - DVec2::X).length() < 1e-12, "{:?}", world.state(bob));
        world.warnings().to_vec()
    };
    assert_eq!(warnings(0.0), Vec::<String>::new());
    assert_eq!(
        warnings(0.25),
        [
            "the velocities at the start, by which connector 0 (rod of \"world\" and \"bob\") comes apart at 0.25 m/s, were \
             changed to fit"
        ]
    );
}

#[test]
fn the_velocity_of_a_fixed_body_is_told_to_count_for_nothing() {
    let shape = Shape::disc(0.5).expect("a fine radius");
    let mut fixed = BodySpec::fixed("stone", shape, DVec2::ZERO);
    let warnings = |spec: &BodySpec| {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        builder.add(spec.clone());
        builder.add(disc("free", 1.0, DVec2::new(3.0, 0.0)));
        build(builder).warnings().to_vec()
    };
    assert_eq!(warnings(&fixed), Vec::<String>::new());
    fixed.state.angular_velocity = 1.0;
    assert_eq!(warnings(&fixed), ["body \"stone\" is fixed: its velocity is ignored"]);
}

#[test]
fn a_linkage_with_more_bars_than_it_needs_is_put_together() {
    // Three parallel cranks carry one plate: any two would do, and all three are off by a little.
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let state = BodyState {
        position: DVec2::new(0.6, 0.8) + DVec2::new(3e-7, -2e-7),
        angle: 1e-7,
        ..BodyState::default()
    };
    let plate =
        builder.add(BodySpec::movable("plate", Shape::block(4.0, 0.5).expect("fine sides"), 2.0, state));
    let joints: Vec<_> = [-1.5, 0.0, 1.5]
        .into_iter()
        .map(|x| {
            builder.add_connector(rod(at(x, 0.0), Anchor { body: plate, point: DVec2::new(x, 0.0) }, 1.0))
        })
        .collect();
    let world = build(builder);
    assert!(largest_error(&world, &joints) < 1e-14, "{}", largest_error(&world, &joints));
    assert!(world.start_correction() > 0.0 && world.start_correction() < 1e-6);
}

#[test]
fn velocities_are_made_to_fit_and_the_loss_is_booked() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let state =
        BodyState { position: DVec2::new(2.0, 0.0), velocity: DVec2::new(3.0, 4.0), ..BodyState::default() };
    let bob = builder.add(BodySpec::movable("bob", Shape::disc(0.5).expect("fine"), 2.0, state));
    builder.add_gravity(bob, DVec2::new(0.0, -10.0));
    builder.add_connector(rod(at(0.0, 0.0), center(bob), 2.0));
    let world = build(builder);
    assert!(
        (world.state(bob).velocity - DVec2::new(0.0, 4.0)).length() < 1e-15,
        "{}",
        world.state(bob).velocity
    );
    let ledger = world.ledger();
    assert!((ledger.start_correction + 9.0).abs() < 1e-14, "{ledger:?}");
    assert!((ledger.start - 16.0).abs() < 1e-14 && ledger.integration_error().abs() < 1e-13, "{ledger:?}");
}

#[test]
fn gaps_are_lifted_without_taking_connectors_apart() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let floor = Shape::block(10.0, 1.0).expect("fine sides");
    builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
    // The disc is exactly on the floor, and hung on a slanting rod: it must move to the side to get up.
    let ball = builder.add(disc("ball", 1.0, DVec2::new(0.0, 0.5)));
    let joint = builder.add_connector(rod(at(3.0, 4.5), center(ball), 5.0));
    let world = build(builder);
    let tolerances = *world.tolerances();
    let gap = world.state(ball).position.y - 0.5;
    assert!((gap - tolerances.target_gap).abs() <= tolerances.accuracy, "{gap}");
    assert!(world.connector_error(joint) < 1e-14);
    assert!(world.state(ball).position.x < -0.5 * gap);
}

#[test]
fn joined_bodies_overlap_freely_unless_they_are_to_collide() {
    let world = |collide: bool| {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        let a = builder.add(disc("a", 1.0, DVec2::ZERO));
        let b = builder.add(disc("b", 1.0, DVec2::new(0.3, 0.0)));
        let joint = pin(Anchor { body: a, point: DVec2::new(0.3, 0.0) }, center(b));
        builder.add_connector(ConnectorSpec { collide, ..joint });
        builder.build()
    };
    assert!(world(false).is_ok());
    assert!(matches!(world(true), Err(WorldError::Overlap { .. })));
}

#[test]
fn aligned_bodies_are_moved_one_after_another() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let links: Vec<_> =
        (0..3).map(|link| builder.add(disc(&format!("{link}"), 1.0, DVec2::new(5.0, 5.0)))).collect();
    let aligned = |connector: ConnectorSpec| ConnectorSpec { align: true, ..connector };
    let rim = |body, x| Anchor { body, point: DVec2::new(x, 0.0) };
    builder.add_connector(aligned(pin(at(1.0, 1.0), rim(links[0], -1.0))));
    builder.add_connector(aligned(pin(rim(links[0], 1.0), rim(links[1], -1.0))));
    // The background cannot be moved, so body a is.
    builder.add_connector(aligned(pin(rim(links[2], -1.0), at(8.0, 2.0))));
    let world = build(builder);
    let places: Vec<_> = links.iter().map(|&link| world.state(link).position).collect();
    assert_eq!(places, [DVec2::new(2.0, 1.0), DVec2::new(4.0, 1.0), DVec2::new(9.0, 2.0)]);
}

#[test]
fn a_connector_that_names_no_body_is_refused() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let bob = builder.add(disc("bob", 1.0, DVec2::ZERO));
    builder.add_connector(pin(center(bob), center(BodyId(7))));
    let error = builder.build().expect_err("there is no body 7");
    assert_eq!(error.to_string(), "connector 0 names body 7, but there are 1 bodies");
}

#[test]
fn a_body_too_far_out_to_compute_with_is_refused_by_name_and_number() {
    let near = || disc("near", 1.0, DVec2::ZERO);
    let refusal = |body: BodySpec| {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        builder.add(near());
        builder.add(body);
        builder.build().expect_err("a square of it is no number").to_string()
    };
    for far in [1e61, 1e154, 1e308, -1e308, f64::MAX] {
        let place = refusal(disc("far", 1.0, DVec2::new(0.5, far)));
        assert_eq!(place, format!("body \"far\": position must be at most 1e60 in size, got {far:e}"));
        let velocity = DVec2::new(far, 0.0);
        let state = BodyState { velocity, ..BodyState::default() };
        let speed = refusal(BodySpec { state, ..disc("fast", 1.0, DVec2::ZERO) });
        assert_eq!(speed, format!("body \"fast\": velocity must be at most 1e60 in size, got {far:e}"));
        let state = BodyState { angular_velocity: far, ..BodyState::default() };
        let spin = refusal(BodySpec { state, ..disc("spun", 1.0, DVec2::ZERO) });
        assert_eq!(
            spin,
            format!("body \"spun\": angular velocity must be at most 1e60 in size, got {far:e}")
        );
        let center_of_mass = Some(DVec2::new(0.0, far));
        let center = refusal(BodySpec { center_of_mass, ..disc("lopsided", 1.0, DVec2::ZERO) });
        assert_eq!(
            center,
            format!("body \"lopsided\": centre of mass must be at most 1e60 in size, got {far:e}")
        );
    }
    let large = BodySpec::fixed("large", Shape::disc(1e65).expect("a radius"), DVec2::ZERO);
    assert!(
        refusal(large).contains("\"large\": coordinates of the shape must be at most 1e60 in size, got ")
    );
}

#[test]
fn coordinates_whose_rounding_hides_the_smallest_body_are_refused() {
    // Half a metre over 512 machine epsilons.
    let largest = 0.5 / (512.0 * f64::EPSILON);
    let world = |place: DVec2| {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        builder.add(disc("near", 1.0, DVec2::ZERO));
        let state = BodyState { position: place, ..BodyState::default() };
        builder.add(BodySpec::movable("far", Shape::disc(3.0).expect("a radius"), 1.0, state));
        builder.build()
    };
    for far in [1e13, 1e20, 1e60] {
        let error = world(DVec2::new(0.0, -far)).expect_err("too far").to_string();
        let beginning = format!("body \"far\": coordinates must be at most {largest:e} in size, got ");
        assert!(error.starts_with(&beginning), "{error}");
    }
    let mut world = world(DVec2::new(0.0, -0.9 * largest)).expect("just near enough");
    world.advance_to(1.0, &mut |_| {}).expect("nothing is in the way");
    assert_eq!(world.time(), 1.0);
}

#[test]
fn a_connector_too_far_out_is_refused_by_name_and_number() {
    for (far, largest) in [(1e200, 1e60), (1e20, 0.5 / (512.0 * f64::EPSILON))] {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        let bob = builder.add(disc("bob", 1.0, DVec2::ZERO));
        builder.add_connector(rod(at(0.0, -far), center(bob), 1.0));
        let error = builder.build().expect_err("too far").to_string();
        let whole = format!(
            "connector 0 (rod of \"world\" and \"bob\"): coordinates must be at most {largest:e} m in size, got {far:e} m"
        );
        assert_eq!(error, whole);
    }
}

/// Blocks on each other whose places and angles are off by a billionth: a block lifted off one corner comes down on
/// the other, and all of them lean on each other.
#[test]
fn blocks_that_overlap_a_little_with_a_corner_each_are_lifted_together() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let floor = Shape::block(20.0, 1.0).expect("a fine size");
    builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
    let turns = [-4.9e-10, 5.1e-10, 8.5e-10, 6.2e-10, -4.9e-10, 3.6e-10];
    let lower = [4.5e-10, -4.8e-10, -0.5e-10, -7.5e-10, -4.1e-10, 2.6e-10];
    let blocks: Vec<BodyId> = (0..turns.len())
        .map(|level| {
            let block = Shape::block(1.0, 1.0).expect("a fine size");
            let position = DVec2::new(0.0, 0.5 + level as f64 + lower[level]);
            let state = BodyState { position, angle: turns[level], ..BodyState::default() };
            builder.add(BodySpec::movable(&format!("block {level}"), block, 1.0, state))
        })
        .collect();
    let world = build(builder);
    assert!(world.start_correction() < 5e-9, "{} m", world.start_correction());
    for pair in blocks.windows(2) {
        let ([a, b], pose) = ([pair[0], pair[1]], |body| world.state(body).pose());
        let gap = world.shape(a).distance(&pose(a), world.shape(b), &pose(b));
        assert!(gap.distance > 0.2 * world.tolerances().target_gap, "{gap:?} at {pair:?}");
    }
}

#[test]
fn discs_that_touch_in_a_triangle_all_touch_after_they_are_lifted() {
    // The heavy disc stays, and the others push each other aside by the least displacement, beyond their target gap
    // from it.
    let corners = [DVec2::ZERO, DVec2::new(0.6, 0.0), DVec2::new(-0.23333333333333336, 0.5527707983925666)];
    let radii = [0.1, 0.5, 0.5];
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let discs: Vec<BodyId> = [10.0, 1.0, 1.0]
        .iter()
        .zip(corners.iter().zip(radii))
        .map(|(&mass, (&position, radius))| {
            let state = BodyState { position, ..BodyState::default() };
            let shape = Shape::disc(radius).expect("a fine radius");
            builder.add(BodySpec::movable(&format!("disc of {radius} at {position}"), shape, mass, state))
        })
        .collect();
    let world = build(builder);
    let target = world.tolerances().target_gap;
    for (a, b) in [(0, 1), (0, 2), (1, 2)] {
        let places = [a, b].map(|index: usize| world.state(discs[index]).position);
        let gap = places[0].distance(places[1]) - radii[a] - radii[b];
        assert!((gap - target).abs() < 0.1 * target, "{a} and {b}: {gap:e} m for {target:e} m");
    }
}

#[test]
fn discs_in_a_bearing_with_less_play_than_gaps_stay_where_they_are_given() {
    // To first order a disc that is lifted off the ring and the shaft could be anywhere along them.
    let overrides =
        ToleranceOverrides { target_gap: Some(2e-4), accuracy: Some(2e-7), ..ToleranceOverrides::default() };
    let mut builder = WorldBuilder::new(WorldSettings { overrides, ..WorldSettings::default() });
    let ring = Shape::ring(1.3177244644872448, 1.2177244644872447).expect("a fine ring");
    builder.add(BodySpec::fixed("ring", ring, DVec2::ZERO));
    let mut add = |name: &str, radius: f64, mass: f64, place: [f64; 2]| {
        let state = BodyState { position: DVec2::from(place), ..BodyState::default() };
        let shape = Shape::disc(radius).expect("a fine radius");
        (builder.add(BodySpec::movable(name, shape, mass, state)), state.position)
    };
    let given = [
        add("shaft", 1.0, 5.0, [0.0, -6.607149897213634e-05]),
        add("upper ball", 0.10875211307866887, 0.11, [-0.15851461193418254, 1.0974737208241774]),
        add("lower ball", 0.10875211307866887, 0.4, [-0.31433179152945007, -1.0633771555427525]),
        add("right ball", 0.10875211307866887, 0.5, [0.6268429752923347, -0.914682094731805]),
    ];
    let world = build(builder);
    for (body, place) in given {
        let moved = world.state(body).position.distance(place);
        assert!(moved < 0.02, "{}: {moved} m", world.name(body));
    }
}
