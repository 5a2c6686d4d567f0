//! Stops of rails, with straight pieces, arcs and corners between them and their point.

use halfgap::geometry::DVec2;
use halfgap::scene::{Scene, SceneError, SceneFormat};
use halfgap::{Event, World};
use halfgap_tests::world_of;
use std::ops::ControlFlow;

/// A rail of a slope, a hollow of radius 1 m and a slope back up, and a bead that starts on the first slope; the stop
/// is on the last one.
const RAIL: &str = r#"
format = "halfgap-scene-1"
title = "test"
run = { duration = 10.0 }
force = [{ gravity = { acceleration = [0.0, -10.0] } }]

[[body]]
name = "bead"
shape = { disc = { radius = 0.1 } }
mass = 1.0
position = [-2.1213203435596424, 2.1213203435596424]
"#;
const PATH: &str = "path = { start = [-2.7071067811865475, 2.7071067811865475], edges = [\
    { line = [-0.7071067811865476, 0.7071067811865475] }, \
    { arc = { to = [0.7071067811865476, 0.7071067811865475], center = [0.0, 1.4142135623730951] } }, \
    { line = [2.7071067811865475, 2.7071067811865475] }] }";
/// Arc length [m] and place [m] of the stop.
const STOP_AT: f64 = 5.5;
const SLOPE: f64 = 2.0 * std::f64::consts::SQRT_2;

fn bead_on_rail() -> World {
    let bead = "a = { body = \"bead\", point = [0.0, 0.0] }";
    world_of(&format!(
        "{RAIL}\n[[connector]]\nrail = {{ {bead}, {PATH} }}\n\n\
         [[connector]]\nrail_stop = {{ {bead}, {PATH}, at = {STOP_AT}, upper = true }}\n"
    ))
}

#[test]
fn a_stop_beyond_the_joints_of_its_rail_turns_its_point_back() {
    let mut world = bead_on_rail();
    let bead = world.find("bead").expect("the bead");
    let on_slope = STOP_AT - SLOPE - std::f64::consts::FRAC_PI_2;
    let place = std::f64::consts::FRAC_1_SQRT_2 * (1.0 + on_slope);
    let mut hits = Vec::new();
    let mut highest = f64::NEG_INFINITY;
    for step in 1..=1000 {
        let until = 0.01 * f64::from(step);
        world
            .advance_to(until, &mut |event| {
                if let Event::Impact(impact) = event {
                    hits.extend(impact.rows.iter().filter_map(|row| Some(row.point?.x)));
                }
            })
            .expect("it goes on");
        highest = highest.max(world.state(bead).position.x);
    }
    assert!(hits.len() > 3, "{} rows of impacts", hits.len());
    assert!(hits.iter().all(|x| (x - place).abs() < 1e-7), "impacts at {hits:?} m, stop at {place} m");
    assert!(highest < place + 1e-7, "{highest} m, stop at {place} m");
}

/// A bead on an arc of radius 1 m about the origin that starts at (1, 0) and ends at an angle [rad], or on a whole
/// circle if the angle is a full turn; it starts at 1 rad with 1 m/s, and nothing pulls.
fn bead_on_arc(end: f64, stops: &str) -> World {
    world_of(&scene_of_arc(end, stops))
}

/// The bead on a whole circle, if the scene can be built.
fn bead_on_ring(stops: &str) -> Result<World, SceneError> {
    let scene = Scene::parse(&scene_of_arc(std::f64::consts::TAU, stops), SceneFormat::Toml)?;
    World::from_scene(&scene)
}

fn scene_of_arc(end: f64, stops: &str) -> String {
    let (sin, cos) = if end < std::f64::consts::TAU { end.sin_cos() } else { (0.0, 1.0) };
    let path = format!(
        "path = {{ start = [1.0, 0.0], edges = [{{ arc = {{ to = [{cos}, {sin}], center = [0.0, 0.0] }} }}] }}"
    );
    let bead = "a = { body = \"bead\", point = [0.0, 0.0] }";
    let stops: String = stops
        .split_terminator(';')
        .map(|stop| format!("[[connector]]\nrail_stop = {{ {bead}, {path}, {stop}, elasticity = 1.0 }}\n\n"))
        .collect();
    let (sin, cos) = 1.0f64.sin_cos();
    format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 20.0 }}\n\n\
         [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\n\
         position = [{cos}, {sin}]\nvelocity = [{}, {cos}]\n\n\
         [[connector]]\nrail = {{ {bead}, {path} }}\n\n{stops}",
        -sin
    )
}

/// Requires that the bead goes to and fro between stops at two angles [rad], at every tenth of a second.
fn require_between(world: &mut World, [low, high]: [f64; 2]) {
    let bead = world.find("bead").expect("the bead");
    let width = high - low;
    for tenth in 1..=200 {
        let time = 0.1 * f64::from(tenth);
        world.advance_to(time, &mut |_| ()).expect("it goes on");
        let unfolded = (1.0 + time - low).rem_euclid(2.0 * width);
        let angle = low + unfolded.min(2.0 * width - unfolded);
        let (sin, cos) = angle.sin_cos();
        let place = world.state(bead).position;
        assert!((place.x - cos).hypot(place.y - sin) < 1e-7, "{time} s: {place} m for {angle} rad");
    }
}

#[test]
fn a_stop_turns_a_bead_back_that_goes_more_than_half_round_in_a_step() {
    for end in [3.5, 4.0, 4.7, 5.5, 6.2] {
        let at = end - 0.01;
        let mut world = bead_on_arc(end, &format!("at = {at}, upper = true;at = 0.01, upper = false"));
        require_between(&mut world, [0.01, at]);
    }
}

#[test]
fn a_stop_of_a_ring_is_met_once_a_lap() {
    for (low, high) in [(0.5, 6.0), (0.1, 3.0), (-1.0, 2.0)] {
        let stops = format!(
            "at = {high}, upper = true;at = {}, upper = false",
            f64::rem_euclid(low, std::f64::consts::TAU)
        );
        let mut world = bead_on_arc(std::f64::consts::TAU, &stops);
        require_between(&mut world, [low, high]);
    }
}

#[test]
fn a_corner_takes_what_is_across_it_whichever_way_it_turns() {
    for turn in [0.1, 0.6, -0.1, -0.6, -1.2] {
        let (sin, cos) = f64::sin_cos(turn);
        let mut world = world_of(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 2.0 }}\n\n\
             [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\n\
             position = [-1.0, 0.0]\nvelocity = [1.0, 0.0]\n\n\
             [[connector]]\nrail = {{ a = {{ body = \"bead\", point = [0.0, 0.0] }}, path = {{ start = [-2.0, 0.0], edges = [\
             {{ line = [0.0, 0.0] }}, {{ line = [{}, {}] }}] }} }}\n",
            5.0 * cos,
            5.0 * sin
        ));
        let bead = world.find("bead").expect("the bead");
        world.advance_to(2.0, &mut |_| ()).expect("it goes on");
        let (place, expected) = (world.state(bead).position, [cos * cos, cos * sin]);
        assert!((place.x - expected[0]).hypot(place.y - expected[1]) < 1e-9, "{turn} rad: {place} m");
        let ledger = world.ledger();
        assert!((ledger.impacts + 0.5 * sin * sin).abs() < 1e-12 && ledger.captures == 0.0, "{ledger:?}");
    }
}

#[test]
fn a_bead_comes_to_rest_in_a_corner_of_its_rail() {
    for half in [0.35, 0.5, std::f64::consts::FRAC_PI_4] {
        let (sin, cos) = half.sin_cos();
        let mut world = world_of(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 1000.0 }}\n\
             force = [{{ gravity = {{ acceleration = [0.0, -10.0] }} }}]\n\n\
             [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\nposition = [{}, {sin}]\n\n\
             [[connector]]\nrail = {{ a = {{ body = \"bead\", point = [0.0, 0.0] }}, path = {{ start = [{}, {}], edges = [\
             {{ line = [0.0, 0.0] }}, {{ line = [{}, {}] }}] }} }}\n",
            -cos,
            -2.0 * cos,
            2.0 * sin,
            2.0 * cos,
            2.0 * sin
        ));
        let mut rests = Vec::new();
        let mut note = |event: &Event| {
            if let Event::ContactBegins(begin) = event {
                rests.push((begin.time, begin.contact.connector));
            }
        };
        world.advance_to(1000.0, &mut note).expect("the corner holds it");
        // The bead slides down 1 m, and at each pass its speed is multiplied by the cosine of the turn, up and down
        // again.
        let (rate, kept) = (10.0 * sin, (2.0 * half).cos());
        let first = (2.0 / rate).sqrt();
        let expected = first * (1.0 + 2.0 * kept / (1.0 - kept));
        let [(time, Some(_)), (_, Some(_))] = rests[..] else { panic!("two sides hold it: {rests:?}") };
        assert!((time - expected).abs() < 1e-3, "{half}: {time} s for {expected} s");
        let bead = world.find("bead").expect("the bead");
        let state = world.state(bead);
        assert!(state.position.length() < 1e-10 && state.velocity.length() < 1e-10, "{state:?}");
    }
}

#[test]
fn stops_back_to_back_on_a_ring_are_refused() {
    let scene = |stops: &str| bead_on_ring(stops).map_err(|error| error.to_string());
    let wall = "at = 0.0, upper = false;at = 6.283185307179586, upper = true";
    let Err(refused) = scene(wall) else { panic!("they lie at one place") };
    assert!(
        refused.contains("connector 1 (rail_stop") && refused.contains("connector 2 (rail_stop"),
        "{refused}"
    );
    scene("at = 0.1, upper = false;at = 6.1, upper = true").expect("there is room between them");
}

#[test]
fn a_stop_lets_go_what_has_left_its_spline_by_the_other_end() {
    // The rail is most of a circle, on which the bead sets out backwards. It comes nearer to the other end than to its
    // own.
    let angles = (0..9).map(|place| 0.3 + 0.7 * f64::from(place));
    let points: Vec<String> = angles.map(|angle| format!("[{}, {}]", angle.cos(), angle.sin())).collect();
    let rail = format!(
        "a = {{ body = \"bead\", point = [0.0, 0.0] }}, path = {{ points = [{}] }}",
        points.join(", ")
    );
    let scene = |stop: &str| {
        let (sin, cos) = 1.0f64.sin_cos();
        world_of(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 5.0 }}\n\
             [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\n\
             position = [{cos}, {sin}]\nvelocity = [{sin}, {}]\n[[connector]]\nrail = {{ {rail} }}\n{stop}",
            -cos
        ))
    };
    let end = |mut world: World| {
        world.advance_to(5.0, &mut |_| {}).expect("it goes on");
        world.state(world.find("bead").expect("the bead")).position
    };
    let stopped = scene(&format!("[[connector]]\nrail_stop = {{ {rail}, at = 4.0, upper = true }}\n"));
    let (free, stopped) = (end(scene("")), end(stopped));
    assert!((free - stopped).length() < 1e-9, "{stopped}, not {free}");
}

#[test]
fn a_carriage_that_a_rope_jerks_at_its_stop_goes_on_with_steps_of_a_given_length() {
    // A method of low order leaves the carriage a little beyond the stop, from which it sets out by less than that
    // distance.
    let scene = |integrator: &str, stabilization: &str| {
        let path = "path = { start = [-2.5744623043915458, 1.375120050582826], edges = [\
                    { line = [2.5744623043915458, -1.375120050582826] }] }";
        let point = "a = { body = \"car\", point = [0.022165507618524843, 0.08361743710666245] }";
        world_of(&format!(
            r#"
format = "halfgap-scene-1"
title = "A carriage at its stop"
run = {{ duration = 5.0, integrator = "{integrator}", time_step = 0.002, stabilization = "{stabilization}" }}
force = [{{ gravity = {{ acceleration = [-2.7802105203430347, -6.0] }} }}]

[[body]]
name = "car"
shape = {{ block = {{ width = 0.5, height = 0.3 }} }}
mass = 1.009939289938767
position = [-0.5141744931728811, 0.17918362234121074]
velocity = [0.7483336259118866, -0.3997139797935362]

[[body]]
name = "bob"
shape = {{ block = {{ width = 0.3, height = 0.5 }} }}
mass = 0.7511079230864344
position = [-0.49200898555435624, -0.6657800157150418]
velocity = [0.5072230741044295, 0.4422700805839088]
passes_through = ["car"]
elasticity = 0.5

[[connector]]
rail = {{ {point}, {path} }}

[[connector]]
rail_stop = {{ {point}, {path}, at = 5.253660499613897, upper = true, elasticity = 0.0 }}

[[connector]]
rope = {{ {point}, b = {{ body = "bob", point = [0.0, 0.0] }}, length = 1.018715258540035, elasticity = 0.4 }}
"#
        ))
    };
    for (integrator, stabilization) in
        [("modified_euler", "projection"), ("modified_euler", "none"), ("rk4", "velocity_and_distance")]
    {
        let mut world = scene(integrator, stabilization);
        let mut events = 0;
        let outcome = world.advance_while(5.0, &mut |_| {
            events += 1;
            if events < 10_000 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert_eq!(
            outcome,
            Ok(ControlFlow::Continue(())),
            "{integrator}, {stabilization}: at {} s",
            world.time()
        );
    }
}

/// A bead on a rail of two lines, from (0, 0) to (1, 0) and on to an end, half a metre before or after the corner.
fn bead_before_corner(end: [f64; 2], comes_forward: bool, stop: &str, pull: f64) -> World {
    let side = DVec2::from(end) - DVec2::X;
    let away = if comes_forward { -DVec2::X } else { side.normalize() };
    let (place, velocity, pull) = (DVec2::X + 0.5 * away, -away, -pull * away);
    let rail = format!(
        "a = {{ body = \"bead\", point = [0.0, 0.0] }}, path = {{ start = [0.0, 0.0], edges = [{{ line = [1.0, 0.0] }}, \
         {{ line = [{:?}, {:?}] }}] }}",
        end[0], end[1]
    );
    world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 10.0 }}\n\
         force = [{{ gravity = {{ acceleration = [{:?}, {:?}] }} }}]\n\n\
         [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\n\
         position = [{:?}, {:?}]\nvelocity = [{:?}, {:?}]\n\n\
         [[connector]]\nrail = {{ {rail} }}\n\n[[connector]]\nrail_stop = {{ {rail}, {stop} }}\n",
        pull.x, pull.y, place.x, place.y, velocity.x, velocity.y
    ))
}

/// Ends of the second line, which turns by 10, 45, -45, 90 and 135 degrees.
const ENDS: [[f64; 2]; 5] = [[2.0, 0.17], [2.0, 1.0], [2.0, -1.0], [1.0, 1.0], [0.2, 0.8]];

#[test]
fn a_bead_that_bounces_off_a_stop_in_a_corner_does_not_turn() {
    for end in ENDS {
        for (upper, off) in [(true, 0.0), (false, 0.0), (true, 1e-12), (false, -1e-12)] {
            let stop = format!("at = {:?}, upper = {upper}, elasticity = 0.5", 1.0 + off);
            let mut world = bead_before_corner(end, upper, &stop, 0.0);
            let bead = world.find("bead").expect("the bead");
            let before = world.state(bead);
            world.advance_to(1.5, &mut |_| ()).expect("it goes on");
            let (state, expected) = (world.state(bead), -0.5 * before.velocity);
            assert!(state.velocity.distance(expected) < 1e-9, "{end:?}, {stop}: {state:?}");
            assert!(state.position.distance(before.position) < 1e-9, "{end:?}, {stop}: {state:?}");
        }
    }
}

#[test]
fn a_bead_that_bounces_ever_lower_comes_to_rest_at_a_stop_near_a_corner() {
    for end in ENDS {
        for (upper, at) in [(true, 0.99_f64), (true, 1.0), (false, 1.01), (false, 1.000001), (false, 1.0)] {
            let stop = format!("at = {at:?}, upper = {upper}, elasticity = 0.5");
            let mut world = bead_before_corner(end, upper, &stop, 3.0);
            let bead = world.find("bead").expect("the bead");
            let away = (world.state(bead).position - DVec2::X).normalize();
            world.advance_to(5.0, &mut |_| ()).expect("it goes on");
            let (state, expected) = (world.state(bead), DVec2::X + (at - 1.0).abs() * away);
            assert!(state.position.distance(expected) < 1e-9, "{end:?}, {stop}: {state:?}");
            assert!(state.velocity.length() < 1e-9, "{end:?}, {stop}: {state:?}");
        }
    }
}

#[test]
fn a_stop_whose_rail_is_not_there_is_met_round_a_bend_of_its_path_and_somebody_is_told() {
    // A spring leads the bead about along the path, not on it.
    let world = |at: f64| {
        world_of(&format!(
            r#"
format = "halfgap-scene-1"
title = "A stop alone"
run = {{ duration = 4.0, tolerance = 1e-9 }}
force = [{{ spring = {{ a = {{ body = "world", point = [1.0, 1.0] }}, b = {{ body = "bead", point = [0.0, 0.0] }}, rest_length = 0.6, stiffness = 2.5 }} }}]
body = [{{ name = "bead", shape = {{ disc = {{ radius = 0.1 }} }}, mass = 1.0, position = [0.3, 0.02], velocity = [1.0, 0.0] }}]

[[connector]]
rail_stop = {{ a = {{ body = "bead", point = [0.0, 0.0] }}, at = {at:?}, upper = true, path = {{ start = [0.0, 0.0], edges = [
    {{ line = [1.0, 0.0] }}, {{ arc = {{ to = [2.0, 1.0], center = [1.0, 1.0] }} }}, {{ line = [2.0, 3.0] }}] }} }}
"#
        ))
    };
    // Expected times: an adaptive integration (order 5, 1e-11) with the arc length of the nearest place as event.
    for (at, expected) in [(1.3, 0.77576524), (1.8, 1.04249456), (2.2, 1.31344453), (3.0, 2.28725136)] {
        let mut world = world(at);
        let [warning] = world.warnings() else { panic!("{:?}", world.warnings()) };
        assert!(warning.contains("ends no rail"), "{warning}");
        let mut hits = Vec::new();
        let mut note = |event: &Event| {
            if let Event::Impact(impact) = event {
                hits.push(impact.time);
            }
        };
        world.advance_to(expected + 0.05, &mut note).expect("it goes on");
        assert!(matches!(hits[..], [time] if (time - expected).abs() < 2e-8), "{hits:?}, not {expected}");
    }
}

#[test]
fn a_bead_that_comes_to_a_stop_of_a_ring_from_behind_passes_it() {
    // The world is looked at every tenth of a second, also where the bead lies just behind the stop.
    for at in [2.0, 2.7995, 2.9, 2.9999, 3.0001, 6.0] {
        let mut world = bead_on_arc(std::f64::consts::TAU, &format!("at = {at}, upper = false"));
        let bead = world.find("bead").expect("the bead");
        for tenth in 1..=70 {
            let time = 0.1 * f64::from(tenth);
            world.advance_to(time, &mut |_| ()).expect("it goes on");
            let place = world.state(bead).position;
            let (sin, cos) = (1.0 + time).sin_cos();
            assert!((place.x - cos).hypot(place.y - sin) < 1e-7, "{at} m, {time} s: {place} m");
        }
    }
}

#[test]
fn a_bead_that_swings_behind_a_stop_of_a_ring_is_not_held_by_it() {
    // The bead swings at the bottom of the ring, never on the stopped side: at every tolerance it goes on as without
    // the stop.
    let scene = |tolerance: f64, stop: &str| {
        let path =
            "path = { start = [1.0, 0.0], edges = [{ arc = { to = [1.0, 0.0], center = [0.0, 0.0] } }] }";
        let bead = format!("a = {{ body = \"bead\", point = [0.0, 0.0] }}, {path}");
        let stop = if stop.is_empty() {
            String::new()
        } else {
            format!("[[connector]]\nrail_stop = {{ {bead}, {stop} }}")
        };
        let (sin, cos) = 4.003_f64.sin_cos();
        world_of(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 6.0, tolerance = {tolerance:e} }}\n\
             force = [{{ gravity = {{ acceleration = [0.0, -9.81] }} }}]\n\n\
             [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.1 }} }}\nmass = 1.0\n\
             position = [{cos}, {sin}]\n\n[[connector]]\nrail = {{ {bead} }}\n\n{stop}\n"
        ))
    };
    for tolerance in [1e-3, 1e-5, 1e-8] {
        let mut worlds = ["", "at = 4.0, upper = true"].map(|stop| scene(tolerance, stop));
        let mut blows = 0;
        let states = worlds.each_mut().map(|world| {
            let mut note = |event: &Event| blows += u32::from(matches!(event, Event::Impact(_)));
            world.advance_to(6.0, &mut note).expect("it goes on");
            world.state(world.find("bead").expect("the bead"))
        });
        assert_eq!(blows, 0, "{tolerance}");
        let off = states[0].position.distance(states[1].position);
        assert!(off < 10.0 * tolerance, "{tolerance}: {off} m");
    }
}

#[test]
fn a_stop_on_the_far_side_of_a_hexagon_holds_nothing() {
    // Along its straight pieces a step goes on far beyond the corners, to where other places are nearer.
    let corner = |k: usize| {
        let (sin, cos) = (std::f64::consts::FRAC_PI_3 * k as f64 + std::f64::consts::FRAC_PI_2).sin_cos();
        [cos, sin]
    };
    let edges: String =
        (1..=6).map(|k| corner(k % 6)).map(|[x, y]| format!("{{ line = [{x:?}, {y:?}] }}, ")).collect();
    let [x, y] = corner(0);
    let rail = format!(
        "a = {{ body = \"bead\", point = [0.0, 0.0] }}, path = {{ start = [{x:?}, {y:?}], edges = [{edges}] }}"
    );
    for (start, at) in [(0.44, 5.13), (0.7, 4.6), (0.2, 5.7)] {
        for tolerance in [1e-5, 1e-8, 1e-9, 1e-10] {
            let place = DVec2::from(corner(0)).lerp(DVec2::from(corner(1)), start);
            let mut world = world_of(&format!(
                "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 4.0, tolerance = {tolerance:e} }}\n\
                 force = [{{ gravity = {{ acceleration = [0.0, -9.81] }} }}]\n\n\
                 [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\n\
                 position = [{:?}, {:?}]\n\n[[connector]]\nrail = {{ {rail} }}\n\n\
                 [[connector]]\nrail_stop = {{ {rail}, at = {at:?}, upper = false }}\n",
                place.x, place.y
            ));
            let bead = world.find("bead").expect("the bead");
            world.advance_to(4.0, &mut |_| ()).expect("it goes on");
            // The bead slides down three sides, to the lowest corner and over it, and comes to rest there.
            let state = world.state(bead);
            let off = state.position.distance(DVec2::NEG_Y);
            assert!(off < 1e-6, "{start} m, {at} m, {tolerance}: {state:?}");
        }
    }
}

#[test]
fn a_bead_that_passes_a_stop_of_a_ring_from_behind_and_comes_back_is_held_by_it() {
    // Thrown up through the stop, a bead comes down on it, within one step or several.
    for (speed, behind) in [(1.0, 1e-3), (1.0, 0.02), (0.2, 1e-4), (2.0, 1e-6)] {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            // The stop is at the right of the ring, where gravity points along it; it holds a bead that comes down.
            let stop = 2.0 * std::f64::consts::PI - 0.5;
            let start = stop - behind;
            let (sin, cos) = start.sin_cos();
            let rail = "a = { body = \"bead\", point = [0.0, 0.0] }, \
                        path = { start = [1.0, 0.0], edges = [{ arc = { to = [1.0, 0.0], center = [0.0, 0.0] } }] }";
            let mut world = world_of(&format!(
                "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 3.0, tolerance = {tolerance:e} }}\n\
                 force = [{{ gravity = {{ acceleration = [0.0, -9.81] }} }}]\n\n\
                 [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\n\
                 position = [{cos:?}, {sin:?}]\nvelocity = [{:?}, {:?}]\n\n\
                 [[connector]]\nrail = {{ {rail} }}\n\n\
                 [[connector]]\nrail_stop = {{ {rail}, at = {stop:?}, upper = false, elasticity = 0.5 }}\n",
                -speed * sin,
                speed * cos
            ));
            let bead = world.find("bead").expect("the bead");
            let mut blows = 0;
            let mut note = |event: &Event| blows += u32::from(matches!(event, Event::Impact(_)));
            world.advance_to(3.0, &mut note).expect("it goes on");
            let (state, (sin, cos)) = (world.state(bead), stop.sin_cos());
            let off = state.position.distance(DVec2::new(cos, sin));
            assert!(blows > 1 && off < 10.0 * tolerance, "{speed} {behind} {tolerance}: {blows}, {state:?}");
        }
    }
}

#[test]
fn a_bead_stopped_in_a_corner_without_bounce_slides_back_where_its_piece_leads_down() {
    for end in [[2.0, 0.17], [1.0, 1.0], [0.2, 0.8], [0.0, 0.01]] {
        for upper in [true, false] {
            let mut world =
                bead_before_corner(end, upper, &format!("at = 1.0, upper = {upper}, elasticity = 0.0"), -1.0);
            let bead = world.find("bead").expect("the bead");
            let away = (world.state(bead).position - DVec2::X).normalize();
            // The bead comes with 1 m/s against 1 m/s^2, so that it is stopped just before the corner or comes to rest
            // there, and goes back.
            let comes = world.state(bead).velocity.length();
            assert!((comes - 1.0).abs() < 1e-12);
            world.advance_to(2.0, &mut |_| ()).expect("it goes on");
            // Half a metre at 1 m/s, slowed by 1 m/s^2, takes a second: the bead arrives with no speed.
            let (state, expected) = (world.state(bead), DVec2::X + 0.5 * away);
            assert!(state.position.distance(expected) < 1e-6, "{end:?} {upper}: {state:?}");
        }
    }
}

#[test]
fn stops_between_hairpins_hold() {
    // Three pieces lie nearly on each other; the bead bounces to and fro on the middle one.
    for turn in [179.0_f64, 178.0, 150.0] {
        let (sin, cos) = turn.to_radians().sin_cos();
        let corner = DVec2::X + DVec2::new(cos, sin);
        let rail = format!(
            "a = {{ body = \"bead\", point = [0.0, 0.0] }}, path = {{ start = [0.0, 0.0], edges = [{{ line = [1.0, 0.0] }}, \
             {{ line = [{:?}, {:?}] }}, {{ line = [1.0, {:?}] }}] }}",
            corner.x,
            corner.y,
            2.0 * corner.y
        );
        for (low, high) in [(1.1, 1.98), (1.01, 1.5), (1.001, 1.999)] {
            let along = (corner - DVec2::X).normalize();
            let place = DVec2::X + 0.5 * (low + high - 2.0) * along;
            let mut world = world_of(&format!(
                "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 10.0 }}\n\n\
                 [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\n\
                 position = [{:?}, {:?}]\nvelocity = [{:?}, {:?}]\n\n[[connector]]\nrail = {{ {rail} }}\n\n\
                 [[connector]]\nrail_stop = {{ {rail}, at = {low:?}, upper = false, elasticity = 1.0 }}\n\n\
                 [[connector]]\nrail_stop = {{ {rail}, at = {high:?}, upper = true, elasticity = 1.0 }}\n",
                place.x, place.y, along.x, along.y
            ));
            let bead = world.find("bead").expect("the bead");
            world.advance_to(7.3, &mut |_| ()).expect("it goes on");
            let width = high - low;
            let unfolded = (0.5 * width + 7.3).rem_euclid(2.0 * width);
            let arc = low + unfolded.min(2.0 * width - unfolded);
            let (place, expected) = (world.state(bead).position, DVec2::X + (arc - 1.0) * along);
            assert!(place.distance(expected) < 1e-7, "{turn} {low} {high}: {place}, not {expected}");
        }
    }
}
