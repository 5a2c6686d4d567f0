//! What callers are told of friction in events: the heat of each contact, and jams.

use halfgap::scene::{RunData, Scene};
use halfgap::{Event, World};
use halfgap_tests::{data, names_in};

/// The world of a scene that lacks but its format, its title and its gravity.
fn world_of(text: &str) -> World {
    let gravity = "[[force]]\ngravity = { acceleration = [0.0, -10.0] }\n";
    halfgap_tests::world_of(&format!("format = \"halfgap-scene-1\"\ntitle = \"friction\"\n{text}{gravity}"))
}

/// Blocks that slide on a floor and on each other, and discs that roll and slip on it, some against resistance.
fn blocks_and_discs() -> World {
    let mut text = String::from(
        "run = { duration = 3.0, tolerance = 1e-9 }\n[[body]]\nname = \"floor\"\nfixed = true\nfriction = 0.5\n\
         shape = { block = { width = 2e3, height = 1.0 } }\nposition = [0.0, -0.5]\n",
    );
    for (index, speed) in [3.0, -2.0, 1.0].into_iter().enumerate() {
        let at = 20.0 * index as f64;
        text += &format!(
            "[[body]]\nname = \"block{index}\"\nfriction = 0.3\nelasticity = 0.0\nmass = 2.0\n\
             shape = {{ block = {{ width = 2.0, height = 0.4 }} }}\nposition = [{at:?}, 0.2]\nvelocity = [{speed:?}, 0.0]\n\
             [[body]]\nname = \"rider{index}\"\nfriction = 0.2\nelasticity = 0.0\nmass = 0.5\n\
             shape = {{ block = {{ width = 0.4, height = 0.4 }} }}\nposition = [{at:?}, 0.6]\n\
             [[body]]\nname = \"disc{index}\"\nfriction = 0.4\nrolling_resistance = 0.0{index}\nelasticity = 0.5\nmass = 1.0\n\
             shape = {{ disc = {{ radius = 0.5 }} }}\nposition = [{:?}, 0.8]\nvelocity = [{speed:?}, 0.0]\n",
            at + 8.0
        );
    }
    world_of(&text)
}

#[test]
fn the_heat_of_all_contacts_is_what_the_ledger_lost_to_friction() {
    let mut world = blocks_and_discs();
    let (mut past, mut turns, mut at_turns) = (0.0, 0, 0.0_f64);
    for time in [0.1, 0.37, 1.0, 3.0] {
        world
            .advance_to(time, &mut |event| match event {
                Event::ContactEnds(event) => past += event.contact.heat.expect("all surfaces are rough"),
                Event::ContactBegins(event) => assert_eq!(event.contact.heat, Some(0.0)),
                Event::Slips(event) | Event::Sticks(event) => {
                    turns += 1;
                    at_turns = at_turns.max(event.contact.heat.expect("all surfaces are rough"));
                }
                _ => (),
            })
            .unwrap_or_else(|error| panic!("{error}"));
        let heats: Vec<f64> = world.contact_forces().iter().filter_map(|contact| contact.heat).collect();
        assert!(heats.len() > 5 && heats.iter().all(|&heat| heat >= 0.0), "{heats:?}");
        let (told, lost) = (past + heats.iter().sum::<f64>(), -world.ledger().friction);
        assert!((told - lost).abs() < 1e-12 * lost, "at {time} s: {told} J, {lost} J");
    }
    assert!(turns > 5 && at_turns > 1.0, "{turns} turns, up to {at_turns} J");
}

#[test]
fn the_heat_of_a_block_that_stops_is_its_energy() {
    let mut world = world_of(
        r#"
        run = { duration = 2.0, tolerance = 1e-10 }
        [[body]]
        name = "floor"
        fixed = true
        friction = 0.5
        shape = { block = { width = 2e2, height = 1.0 } }
        position = [0.0, -0.5]
        [[body]]
        name = "block"
        friction = 0.5
        mass = 2.0
        shape = { block = { width = 1.0, height = 0.5 } }
        position = [0.0, 0.25]
        velocity = [3.0, 0.0]
        "#,
    );
    let mut heat = 0.0;
    world
        .advance_to(2.0, &mut |event| {
            if let Event::Sticks(event) = event {
                heat += event.contact.heat.expect("its surface is rough");
            }
        })
        .expect("it stops");
    assert!((heat - 9.0).abs() < 1e-9, "{heat} J");
    let later: f64 = world.contact_forces().iter().filter_map(|contact| contact.heat).sum();
    assert_eq!(later, heat, "what sticks makes no heat");
}

/// What is told of jams and of contacts that might go on otherwise in a scene with known answers, and its world at the end.
fn oddities(name: &str) -> (Vec<Event>, World) {
    let scene = Scene::read(data(&format!("friction/{name}.json"))).expect("the scene can be read");
    let scene = Scene { run: RunData { tolerance: Some(1e-10), ..scene.run.clone() }, ..scene };
    let mut world = World::from_scene(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut told = Vec::new();
    let mut tell = |event: &Event| {
        if matches!(event, Event::Jams(_) | Event::Undecided(_)) {
            told.push(event.clone());
        }
    };
    world.advance_to(scene.run.duration, &mut tell).unwrap_or_else(|error| panic!("{name}: {error}"));
    (told, world)
}

#[test]
fn a_jam_is_told_with_its_contact_and_its_energy() {
    let (told, world) = oddities("painleve_rod");
    let [Event::Jams(jam)] = told.as_slice() else { panic!("{told:?}") };
    let (energy, bodies) = (jam.energy_change.expect("it jams"), jam.contact.bodies.map(|body| body.0));
    assert_eq!((jam.time, bodies), (0.0, [1, 0]));
    assert!((energy + 0.2).abs() < 1e-7 && (energy - world.ledger().jams).abs() < 1e-12, "{energy} J");
}

#[test]
fn a_contact_that_might_go_on_otherwise_is_told() {
    let (told, world) = oddities("painleve_rod_undecided");
    let [Event::Undecided(undecided)] = told.as_slice() else { panic!("{told:?}") };
    let friction = undecided.contact.friction.expect("it slips");
    assert_eq!((undecided.time, undecided.contact.force, friction.sticks), (0.0, 0.0, false));
    assert!(friction.slip_speed.abs() > 0.1, "{friction:?}");
    assert_eq!((undecided.energy_change, world.ledger().jams), (None, 0.0));
}

#[test]
fn nothing_else_jams_or_is_undecided() {
    for name in names_in("friction").iter().filter(|name| !name.starts_with("painleve")) {
        let (told, _) = oddities(name);
        assert!(told.is_empty(), "{name}: {told:?}");
    }
}
