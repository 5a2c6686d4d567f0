//! The moment in which a contact runs off its features: other events at that moment, and the contacts that take over.

use super::{impacts, within};
use halfgap::geometry::{DVec2, Shape};
use halfgap::scene::Scene;
use halfgap::{BodyState, World};
use halfgap_tests::mechanism::{Workshop, at_rest, block};
use halfgap_tests::world_of;
use std::path::Path;

#[test]
fn a_block_that_slides_off_a_wedge_bounces_off_the_floor() {
    // The block's lower corner comes to the floor where the wedge ends: the contact of the two runs off at the moment
    // of the blow. Nothing takes energy.
    for angle in [1.0_f64, 1.1, 1.3] {
        let mut shop = Workshop::new(1e-8);
        shop.fixed("floor", block(8.0, 0.2), DVec2::new(0.0, -0.1));
        let corners = [DVec2::new(0.0, 0.0), DVec2::new(-2.0, 2.0 * angle.tan()), DVec2::new(-2.0, 0.0)];
        let wedge = Shape::polygon(&corners).expect("a fine wedge");
        shop.body("wedge", wedge, 5.0, at_rest(-4.0 / 3.0, 2.0 / 3.0 * angle.tan()));
        let (along, off) = (DVec2::new(-angle.cos(), angle.sin()), DVec2::new(angle.sin(), angle.cos()));
        let state = BodyState { position: along + 0.1 * off, angle: -angle, ..BodyState::default() };
        shop.body("block", block(0.3, 0.2), 1.0, state);
        let mut world = shop.build();
        let energy = world.energy().total();
        assert!(impacts(&mut world, 0.8) > 0, "it comes to the floor");
        within("block off a wedge: energy, relative", world.energy().total() / energy - 1.0, 1e-9);
    }
}

/// A block lies on the rounds of two of its corners when a disc falls on it: it turns over the flat between them.
/// Where a body may be a millimetre off, the block stands on one corner by the time that the other comes down. Both
/// hold it then.
#[test]
fn a_block_with_round_corners_comes_to_rest_in_few_blows_as_one_with_sharp_ones() {
    for radius in [0.0, 0.1, 0.25, 0.4] {
        let shape = if radius == 0.0 {
            "block = { width = 1.48, height = 0.99 }".to_owned()
        } else {
            format!("rounded_block = {{ width = 1.48, height = 0.99, radius = {radius} }}")
        };
        let mut world = world_of(&format!(
            r#"
format = "halfgap-scene-1"
title = "A disc falls on a block"
run = {{ duration = 1.0, target_gap = 0.0015, accuracy = 0.0009 }}
force = [{{ gravity = {{ acceleration = [0.0, -10.0] }} }}]

[[body]]
name = "floor"
fixed = true
shape = {{ block = {{ width = 7.4, height = 1.0 }} }}
position = [0.0, -3.2]
elasticity = 0.0

[[body]]
name = "disc"
mass = 1.0
shape = {{ disc = {{ radius = 0.5 }} }}
position = [-1.405, -0.52]
velocity = [2.97, 0.906]
elasticity = 0.0

[[body]]
name = "block"
mass = 1.0
shape = {{ {shape} }}
position = [0.294, -1.4555]
angle = 3.6545
elasticity = 0.0
"#
        ));
        let block = world.find("block").expect("it is there");
        let blows = impacts(&mut world, 1.0);
        assert!(blows < 10, "radius {radius} m: {blows} impacts");
        let height = world.state(block).position.y + 2.7 - 0.5 * 0.99;
        within(&format!("block with corners of {radius} m: gap off its target [m]"), height - 0.0015, 0.0009);
    }
}

/// A sharp tip of a swinging body rests on an arc about the pivot of another, which swings away under it.
fn tip_on_sector(tolerance: f64) -> World {
    world_of(&format!(
        r#"
format = "halfgap-scene-1"
title = "A tip on a sector"
run = {{ duration = 1.0, tolerance = {tolerance:e} }}

[[body]]
name = "sector"
position = [0.0, -1.0]
center_of_mass = [0.0, -1.0]
mass = 1.0
moment = 0.2
velocity = [-0.3, 0.0]
angular_velocity = -0.3
elasticity = 0.0
[[body.shape.outline.paths]]
start = [0.45, 0.7794228634059948]
edges = [
    {{ line = [0.5, 0.8660254037844386] }},
    {{ arc = {{ to = [-0.08, 0.9967948635501690], center = [0.0, 0.0] }} }},
    {{ line = [-0.072, 0.8971153771951521] }},
    {{ arc = {{ to = [0.45, 0.7794228634059948], center = [0.0, 0.0], clockwise = true }} }},
]

[[body]]
name = "tip"
shape = {{ polygon = {{ vertices = [[0.0, 1.0], [0.05, 1.2], [-0.05, 1.2]] }} }}
position = [0.0, 1.0]
center_of_mass = [0.0, 1.0]
mass = 1.0
moment = 0.1
elasticity = 0.0

[[connector]]
pin = {{ a = {{ body = "world", point = [0.0, 0.0] }}, b = {{ body = "sector", point = [0.0, 0.0] }} }}

[[connector]]
pin = {{ a = {{ body = "world", point = [-1.0, 1.0] }}, b = {{ body = "tip", point = [-1.0, 1.0] }} }}

[[force]]
gravity = {{ acceleration = [0.0, -9.81] }}
"#
    ))
}

#[test]
fn a_tip_slides_off_the_end_of_an_arc_without_a_blow() {
    for power in 6..13 {
        let mut world = tip_on_sector(10.0_f64.powi(-power));
        assert_eq!(impacts(&mut world, 0.4), 0, "at a tolerance of 1e-{power}");
        // The tip has fallen behind the end of the arc.
        let tip = world.find("tip").expect("it is there");
        assert!(world.state(tip).angle < -0.03, "{:?}", world.state(tip));
    }
}

#[test]
fn an_escapement_ticks_alike_at_all_tolerances() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/graham_escapement.toml");
    let scene = Scene::read(path).expect("a fine scene");
    let angle = |tolerance: f64| {
        let mut scene = scene.clone();
        scene.set_tolerance(tolerance, "tolerance").expect("a fine tolerance");
        let mut world = World::from_scene(&scene).expect("a world that can be built");
        assert_eq!(impacts(&mut world, scene.run.duration), 22, "at a tolerance of {tolerance:e}");
        world.state(world.find("pendulum").expect("it is there")).angle
    };
    let fine = angle(1e-12);
    for power in 7..12 {
        let tolerance = 10.0_f64.powi(-power);
        within("Graham's escapement, 20 s: pendulum's angle [rad]", angle(tolerance) - fine, 0.1 * tolerance);
    }
}

/// A disc of 0.2 m slides up a side without losing its corner: it goes about the corner at nearly the speed at which
/// it would fly off, and comes over the next side deeper than its first touch.
struct OverCorner {
    tolerance: f64,
    /// Sides that meet at the origin, by their other ends [m]; an arc between them may start there, given by its end
    /// and its centre [m].
    before: [f64; 2],
    arc: Option<[[f64; 2]; 2]>,
    after: [f64; 2],
    position: [f64; 2],
    velocity: [f64; 2],
}

impl OverCorner {
    fn world(&self) -> World {
        let Self { tolerance, before, arc, after, position, velocity } = self;
        let arc = arc.map_or(String::new(), |[to, center]| {
            format!("{{ arc = {{ to = {to:?}, center = {center:?} }} }},")
        });
        let (foot, other) = ([after[0] - 0.5, -4.0], [before[0] + 0.5, -4.0]);
        world_of(&format!(
            r#"
format = "halfgap-scene-1"
title = "Over a corner"
run = {{ duration = 0.1, tolerance = {tolerance:e} }}
force = [{{ gravity = {{ acceleration = [0.0, -9.81] }} }}]

[[body]]
name = "ground"
fixed = true
center_of_mass = [0.0, 0.0]
[[body.shape.outline.paths]]
start = {before:?}
edges = [
    {{ line = [0.0, 0.0] }}, {arc}
    {{ line = {after:?} }}, {{ line = {foot:?} }}, {{ line = {other:?} }}, {{ line = {before:?} }},
]

[[body]]
name = "disc"
shape = {{ disc = {{ radius = 0.2 }} }}
mass = 1.0
position = {position:?}
velocity = {velocity:?}
elasticity = 0.0
"#
        ))
    }
}

#[test]
fn a_disc_that_all_but_flies_off_a_corner_comes_down_on_the_next_side() {
    let cases = [
        OverCorner {
            tolerance: 1e-8,
            before: [0.571_151_420_502_878_9, -0.820_844_720_308_015_1],
            arc: None,
            after: [-0.571_246_259_463_246_5, 0.820_778_722_341_929],
            position: [0.164_999_703_099_459_77, 0.113_036_337_736_229_33],
            velocity: [-0.610_930_865_066_382_1, 0.878_014_755_914_312_6],
        },
        OverCorner {
            tolerance: 4.891_535_813_115_034e-4,
            before: [0.942_116_990_504_652_7, -0.335_284_321_438_471_14],
            arc: None,
            after: [-0.946_344_205_061_447, 0.323_160_402_194_665_4],
            position: [0.070_896_001_233_811_87, 0.187_057_555_500_007_83],
            velocity: [-1.291_343_049_276_416_2, 0.459_568_272_714_206_14],
        },
        OverCorner {
            tolerance: 7.617_697_012_865_256e-3,
            before: [0.962_053_863_083_273, -0.272_859_605_890_192],
            arc: Some([
                [-5.391_127_370_936_162e-4, 1.416_967_979_533_424_7e-4],
                [-3.931_645_429_417_193e-3, -1.386_227_419_520_166_5e-2],
            ]),
            after: [-0.972_426_856_606_300_7, 0.235_586_410_726_345_87],
            position: [0.062_748_811_121_965_48, 0.190_107_463_354_551_6],
            velocity: [-1.388_523_547_107_360_7, 0.393_815_775_157_041_97],
        },
    ];
    for case in cases {
        let mut world = case.world();
        impacts(&mut world, 0.1);
        let [ground, disc] = ["ground", "disc"].map(|name| world.find(name).expect("it is there"));
        let shapes = [ground, disc].map(|body| world.shape(body).clone());
        let poses = [ground, disc].map(|body| world.state(body).pose());
        let gap = shapes[0].distance(&poses[0], &shapes[1], &poses[1]).distance;
        assert!(gap < 1e-2, "it flies off the ground by the square of the time only: {gap} m");
        // Nor is it deeper than rounding.
        within("disc over a corner: gap, by the tolerance [m]", gap.min(0.0) / case.tolerance, 1e-3);
    }
}

/// A pin on an arm slides off a pallet and swings round behind it, in few steps at coarse tolerances: seen from the
/// edge that it has left, it comes back far below.
#[test]
fn a_pin_that_goes_round_behind_the_edge_it_has_left_does_not_strike_it() {
    for power in 3..11 {
        let tolerance = 10.0_f64.powi(-power);
        let mut world = world_of(&format!(
            r#"
format = "halfgap-scene-1"
title = "A pin on an arm slides off a pallet"
run = {{ duration = 1.6, tolerance = {tolerance:e} }}

[[body]]
name = "arm"
shape = {{ disc = {{ radius = 0.03 }} }}
center_of_mass = [0.96, 0.28]
angle = 0.11
mass = 1.0
moment = 0.06
elasticity = 0.0

[[body]]
name = "pallet"
shape = {{ polygon = {{ vertices = [[-0.66, -0.62], [-0.56, -0.7], [-0.58, -0.35], [-0.69, -0.35]] }} }}
center_of_mass = [0.0, 0.0]
position = [0.0, 1.45]
angle = 0.08
mass = 1.0
moment = 0.32
elasticity = 0.0

[[connector]]
pin = {{ a = {{ body = "world", point = [0.0, 0.0] }}, b = {{ body = "arm", point = [0.96, 0.28] }} }}

[[connector]]
pin = {{ a = {{ body = "world", point = [0.0, 1.45] }}, b = {{ body = "pallet", point = [0.0, 0.0] }} }}

[[force]]
constant = {{ body = "arm", point = [0.0, 0.0], force = [0.0, 0.0], torque = -0.34 }}

[[force]]
[force.spring]
a = {{ body = "world", point = [0.0, 3.45] }}
b = {{ body = "pallet", point = [0.0, -0.5] }}
rest_length = 1.0
stiffness = 0.2
"#
        ));
        assert_eq!(impacts(&mut world, 1.6), 1, "at a tolerance of {tolerance:e}");
        let arm = world.find("arm").expect("it is there");
        // The rate at which it goes about its pivot at a tolerance of 1e-12.
        let rate = world.state(arm).angular_velocity + 2.476_975_133_7;
        within("a pin off a pallet: rate, by the tolerance [rad/s]", rate / tolerance, 0.5);
    }
}
