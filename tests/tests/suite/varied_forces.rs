//! Forces that vary with the time, pushes on points of bodies, and torsion springs.

use halfgap::geometry::DVec2;
use halfgap::scene::{Scene, SceneFormat};
use halfgap::{BodyId, World};
use std::f64::consts::TAU;
use std::fmt::Write;

/// A bar of 2 kg and 0.5 kg m^2 without gravity, with what else is said.
fn bar(run: &str, rest: &str) -> String {
    format!(
        r#"
        format = "halfgap-scene-1"
        title = "t"
        run = {{ duration = 10.0, {run} }}
        [[body]]
        name = "bar"
        shape = {{ block = {{ width = 1.0, height = 0.2 }} }}
        mass = 2.0
        moment = 0.5
        {rest}
        "#
    )
}

fn world(text: &str) -> World {
    halfgap_tests::world_of(text)
}

/// What refuses a scene.
fn refusal(text: &str) -> String {
    let scene = Scene::parse(text, SceneFormat::Toml);
    let refused = scene.map(|scene| World::from_scene(&scene).map(|_| ()));
    match refused {
        Ok(Ok(())) => panic!("it is taken"),
        Ok(Err(error)) => error.to_string(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_push_far_shorter_than_a_step_gives_its_whole_impulse() {
    for (from, until) in [(3.0, 3.0 + 1e-6), (0.1, 0.1 + 1e-9), (0.0, 1e-3), (9.9, 20.0)] {
        let force = format!(
            "[[force]]\npush = {{ body = \"bar\", force = [4.0, 0.0], vary = {{ on = [{from:?}, {until:?}] }} }}"
        );
        let mut world = world(&bar("tolerance = 1e-10", &force));
        world.advance_to(10.0, &mut |_| ()).expect("it flies");
        let (span, state) = (f64::min(until, 10.0) - from, world.state(BodyId(0)));
        let speed = 2.0 * span;
        assert!((state.velocity.x - speed).abs() < 1e-14, "{from}..{until}: {}", state.velocity.x - speed);
        let ledger = world.ledger();
        assert!((ledger.force_laws[0].work - speed * speed).abs() < 1e-14, "{ledger:?}");
    }
}

#[test]
fn a_table_of_thousands_of_kinks_is_followed_from_kink_to_kink() {
    // A saw of 2,000 teeth: each pair of flanks gives the same impulse, here and there.
    let times: Vec<f64> = (0..=4000).map(|k| f64::from(k) * 2.5e-3).collect();
    let values = (0..=4000).map(|k| f64::from(k % 2)).collect::<Vec<_>>();
    let table = format!("vary = {{ table = {{ times = {times:?}, values = {values:?} }} }}");
    let force = format!("[[force]]\npush = {{ body = \"bar\", force = [0.0, 4.0], torque = 1.0, {table} }}");
    let mut world = world(&bar("tolerance = 1e-10", &force));
    world.advance_to(10.0, &mut |_| ()).expect("it flies");
    let state = world.state(BodyId(0));
    assert!((state.velocity - DVec2::new(0.0, 10.0)).length() < 1e-11, "{}", state.velocity);
    assert!((state.angular_velocity - 10.0).abs() < 1e-11, "{}", state.angular_velocity);
    assert!(world.statistics().steps < 9000, "{} steps", world.statistics().steps);
}

#[test]
fn an_oscillator_is_driven_to_its_amplitude_at_resonance() {
    // m x'' + k x = F sin(w t) with w^2 = k/m, from rest: x = F/(2 m w^2) (sin w t - w t cos w t).
    let rest = format!(
        r#"
        [[force]]
        spring = {{ a = {{ body = "world", point = [0.0, 0.0] }}, b = {{ body = "bar", point = [0.0, 0.0] }}, rest_length = 0.0, stiffness = 8.0 }}
        [[force]]
        push = {{ body = "bar", force = [0.5, 0.0], vary = {{ sine = {{ frequency = {:?} }} }} }}
        "#,
        2.0 / TAU
    );
    let mut world = world(&bar("tolerance = 1e-11", &rest));
    world.advance_to(10.0, &mut |_| ()).expect("it swings");
    let (w, t): (f64, f64) = (2.0, 10.0);
    let place = 0.5 / (2.0 * 2.0 * w * w) * ((w * t).sin() - w * t * (w * t).cos());
    assert!((world.state(BodyId(0)).position.x - place).abs() < 1e-10);
    assert!(world.ledger().integration_error().abs() < 1e-10);
}

#[test]
fn a_torsion_spring_counts_whole_turns() {
    // theta = theta0 cos(sqrt(k/I) t), from three and a half turns.
    let start = 7.0 * 0.5 * TAU;
    let rest = format!(
        "angle = {start:?}\n[[force]]\ntorsion_spring = {{ a = \"world\", b = \"bar\", stiffness = 2.0 }}"
    );
    let mut world = world(&bar("tolerance = 1e-11", &rest));
    for time in [1.0, 4.0, 10.0] {
        world.advance_to(time, &mut |_| ()).expect("it turns");
        let angle = start * (2.0 * time).cos();
        assert!(
            (world.state(BodyId(0)).angle - angle).abs() < 1e-9,
            "{time}: {}",
            world.state(BodyId(0)).angle
        );
    }
    let energy = world.energy();
    assert!((energy.total() - start * start).abs() < 1e-8 * start * start, "{energy:?}");
}

#[test]
fn steps_run_them_too() {
    let rest = r#"
        [[force]]
        push = { body = "bar", force = [4.0, 0.0], vary = { on = [0.5, 1.0] } }
        [[force]]
        torsion_spring = { a = "world", b = "bar", rest_angle = 1.0, stiffness = 2.0, damping = 0.1 }
        "#;
    let states = ["tolerance = 1e-10", "strategy = \"steps\", time_step = 1e-3"].map(|run| {
        let mut world = world(&bar(run, rest));
        world.advance_to(10.0, &mut |_| ()).expect("it goes on");
        world.state(BodyId(0))
    });
    let [exact, stepped] = states;
    assert!((exact.position - stepped.position).length() < 1e-2, "{exact:?} {stepped:?}");
    assert!((exact.angle - stepped.angle).abs() < 1e-2, "{exact:?} {stepped:?}");
}

#[test]
fn what_makes_no_sense_is_refused_by_its_field() {
    let push = |vary: &str| {
        bar("", &format!("[[force]]\npush = {{ body = \"bar\", force = [1.0, 0.0], vary = {vary} }}"))
    };
    let mut told = String::new();
    for vary in [
        "{ on = [2.0, 1.0] }",
        "{ table = { times = [0.0, 1.0], values = [1.0] } }",
        "{ table = { times = [1.0, 1.0], values = [1.0, 2.0] } }",
        "{ sine = { frequency = inf } }",
        "{ sine = { frequency = 1.0 }, on = [0.0, 1.0] }",
        "{ ramp = 1.0 }",
    ] {
        writeln!(told, "{}", refusal(&push(vary))).expect("memory takes everything");
    }
    for force in [
        "torsion_spring = { a = \"bar\", b = \"bar\", stiffness = 1.0 }",
        "torsion_spring = { a = \"bar\", b = \"wheel\", stiffness = 1.0 }",
        "torsion_spring = { a = \"world\", b = \"bar\", stiffness = -1.0 }",
        "push = { body = \"world\", force = [1.0, 0.0] }",
        "gravity = { acceleration = [0.0, 1.0], vary = { on = [0.0, 1.0] } }",
    ] {
        writeln!(told, "{}", refusal(&bar("", &format!("[[force]]\n{force}"))))
            .expect("memory takes everything");
    }
    insta::assert_snapshot!(told, @r#"
    line 11: force[0].push.vary.on: must have times that grow, got 1 s after 2 s
    line 11: force[0].push.vary.table: must have a value for each of at least one time, got 2 times and 1 values
    line 11: force[0].push.vary.table: must have times that grow, got 1 s after 1 s
    line 11: force[0].push.vary.sine: must have finite numbers
    line 11: force[0].push.vary: must have exactly one key, found `sine` and `on`
    line 11: force[0].push.vary: unknown field `ramp`, expected one of `sine`, `table`, `on`
    line 11: force[0].torsion_spring: ties "bar" to itself; `a` and `b` must be two bodies
    line 11: force[0].torsion_spring.b: there is no body named "wheel"
    line 11: force[0].torsion_spring.stiffness: must not be negative, got -1 N m/rad
    line 11: force[0].push.body: must be a body, not the background "world"
    line 11: force[0].gravity.vary: unknown field `vary`, expected `acceleration` or `bodies`
    "#);
}
