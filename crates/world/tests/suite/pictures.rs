//! Pictures of recordings: what they show, and that its names and numbers can be read.

use halfgap::picture::{ScenePictures, energy_picture, events_picture};
use halfgap::scene::{Scene, SceneFormat};
use halfgap::{Record, Recording, RunPlan, World, run, unwatched};

/// Room for the title and for the scales on the page of a scene [px].
const HEAD: f64 = 56.0;
const FOOT: f64 = 44.0;

/// A bob of radius 0.1 m at rest at (0, -2).
const BOB: &str = "[[body]]\nname = \"bob\"\nshape = { disc = { radius = 0.1 } }\nmass = 1.0\nposition = [0.0, -2.0]\n\
    [[force]]\ngravity = { acceleration = [0.0, -9.81] }\n";

/// Runs a scene of one second and returns its recording.
fn recorded(parts: &str) -> (World, Recording) {
    recorded_from(0.0, 1.0, parts)
}

fn recorded_from(start: f64, duration: f64, parts: &str) -> (World, Recording) {
    let text = format!(
        "format = \"halfgap-scene-1\"\ntitle = \"{}\"\n[run]\nduration = {duration:e}\nstart_time = {start:e}\n{parts}",
        "A long title ".repeat(20)
    );
    let scene = Scene::parse(&text, SceneFormat::Toml).unwrap_or_else(|error| panic!("{error}"));
    let mut world = World::from_scene(&scene).unwrap_or_else(|error| panic!("{error}"));
    let report = run(&mut world, &RunPlan::of_scene(&scene, Record::Everything), &mut unwatched);
    assert!(report.error.is_none(), "{:?}", report.error);
    (world, report.recording)
}

fn last_picture(parts: &str) -> String {
    let (world, recording) = recorded(parts);
    ScenePictures::new(&world, &recording).at(recording.frames.last().expect("a frame"))
}

/// The values of an attribute.
fn attribute<'a>(picture: &'a str, name: &str) -> impl Iterator<Item = &'a str> {
    let start = format!(" {name}=\"");
    let values: Vec<&str> =
        picture.split(&start).skip(1).map(|rest| rest.split('"').next().unwrap_or_default()).collect();
    values.into_iter()
}

fn size_of(picture: &str) -> [f64; 2] {
    ["width", "height"]
        .map(|name| attribute(picture, name).next().and_then(|size| size.parse().ok()).expect("a size"))
}

/// The corners of the lines drawn with a colour, and the centres of circles.
fn points_of(picture: &str, color: &str) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for line in picture.lines().filter(|line| line.contains(color)) {
        let centers = attribute(line, "cx").zip(attribute(line, "cy")).map(|(x, y)| format!("{x} {y}"));
        let corners = attribute(line, "d").flat_map(|data| data.split(['M', 'L', 'Z']).map(str::to_owned));
        for pair in centers.chain(corners).filter(|pair| !pair.is_empty()) {
            let (x, y) = pair.split_once(' ').expect("two coordinates");
            points.push([x, y].map(|number| number.parse().expect("a number")));
        }
    }
    points
}

fn texts(picture: &str) -> Vec<&str> {
    let texts = picture.split("</text>").filter_map(|part| Some(part.rsplit_once('>')?.1));
    texts.filter(|text| !text.trim().is_empty()).collect()
}

#[test]
fn points_that_connectors_and_springs_tie_lie_in_the_picture() {
    let ties = [
        "[[connector]]\nrod = { a = { body = \"world\", point = [0, 0] }, b = { body = \"bob\", point = [0, 0] }, length = 2 }",
        "[[connector]]\nrope = { a = { body = \"world\", point = [0, 0] }, b = { body = \"bob\", point = [0, 0] }, length = 2 }",
        "[[connector]]\npin = { a = { body = \"world\", point = [0, 0] }, b = { body = \"bob\", point = [0, 2] } }",
        "[[force]]\nspring = { a = { body = \"world\", point = [0, 0] }, b = { body = \"bob\", point = [0, 0] }, rest_length = 1, stiffness = 9.81 }",
        "[[body]]\nname = \"hook\"\nfixed = true\nshape = { disc = { radius = 0.1 } }\n\
         [[connector]]\nrod = { a = { body = \"hook\", point = [0, 0] }, b = { body = \"bob\", point = [0, 0] }, length = 2 }",
    ];
    for tie in ties {
        let picture = last_picture(&format!("{BOB}{tie}"));
        let [width, height] = size_of(&picture);
        let points = points_of(&picture, "#4c5459");
        assert!(!points.is_empty(), "{tie}");
        for [x, y] in points {
            assert!((0.0..width).contains(&x) && (HEAD..height - FOOT).contains(&y), "{tie}: [{x}, {y}]");
        }
    }
}

#[test]
fn a_point_too_far_from_the_moving_bodies_is_not_shown() {
    let spring = "[[force]]\nspring = { a = { body = \"world\", point = [0, 1e6] }, b = { body = \"bob\", point = [0, 0] }, \
        rest_length = 1000002, stiffness = 1 }";
    let picture = last_picture(&format!("{BOB}{spring}"));
    let radius = attribute(&picture, "d")
        .filter_map(|data| data.split_once('A'))
        .map(|(_, arc)| arc.split(' ').next().and_then(|radius| radius.parse().ok()).unwrap_or(0.0));
    assert!(radius.fold(0.0, f64::max) > 5.0, "the bob can be seen");
}

#[test]
fn arrows_of_forces_and_centres_of_mass_lie_in_the_picture() {
    let lying = "[[body]]\nname = \"floor\"\nfixed = true\nshape = { block = { width = 2, height = 0.1 } }\nposition = [0, -0.15]\n\
        [[body]]\nname = \"plate\"\nshape = { block = { width = 1, height = 0.2 } }\nmass = 1.0\nmoment = 1.0\ncenter_of_mass = [0.4, 0.3]\n\
        position = [0.4, 0.3]\n[[force]]\ngravity = { acceleration = [0.0, -9.81] }\n";
    let picture = last_picture(lying);
    let [width, height] = size_of(&picture);
    let arrows = picture.split("<g ").find(|group| group.contains("#c4262e")).expect("arrows of forces");
    let mut points = Vec::new();
    for line in arrows.lines().filter(|line| line.contains("<path")) {
        points.extend(points_of(line, "<path"));
    }
    assert!(points.len() >= 10, "two arrows: {points:?}");
    points.extend(points_of(&picture, "<circle"));
    for [x, y] in points {
        assert!(
            (0.0..width).contains(&x) && (HEAD..height - FOOT).contains(&y),
            "[{x}, {y}] of {width} by {height}"
        );
    }
}

#[test]
fn title_time_and_scales_are_drawn_on_top_of_the_world() {
    let wall = "[[body]]\nname = \"wall\"\nfixed = true\nshape = { block = { width = 1, height = 100 } }\nposition = [2, 0]\n";
    let picture = last_picture(&format!("{wall}{BOB}"));
    let last_of_the_world = ["#d8dbd6", "#22272b\"/>"].map(|mark| picture.rfind(mark).expect("bodies"));
    let first_cover = picture.rfind("<rect y=\"0\"").expect("a cover below the title");
    assert!(last_of_the_world.into_iter().all(|place| place < first_cover), "{picture}");
    for text in ["A long title", ">t = 1.000 s; paths up to here<", " m</text>"] {
        assert!(picture.find(text).is_some_and(|place| place > first_cover), "{text} in {picture}");
    }
}

#[test]
fn a_long_title_ends_with_an_ellipsis_before_the_page_does() {
    let (world, recording) = recorded(BOB);
    let scene = ScenePictures::new(&world, &recording).at(&recording.frames[0]);
    for picture in [scene, energy_picture(&recording), events_picture(&recording)] {
        let title = *texts(&picture).iter().find(|text| text.starts_with("A long")).expect("the title");
        let [width, _] = size_of(&picture);
        assert!(title.ends_with('…') && title.chars().count() as f64 * 9.0 < width, "{title} on {width} px");
    }
}

#[test]
fn labels_of_axes_show_no_rounding_and_do_not_meet() {
    for (start, duration) in
        [(0.0, 3e-5), (0.0, 1e-12), (0.0, 3.2e7), (1_000_000.5, 5.0), (-3.0, 2.0), (1e6, 1e-3)]
    {
        let (_, recording) = recorded_from(
            start,
            duration,
            "[[body]]\nname = \"a\"\nshape = { disc = { radius = 1 } }\nmass = 1e-5\nvelocity = [1e-7, 0]\n",
        );
        let picture = energy_picture(&recording);
        let labels: Vec<&str> =
            texts(&picture).into_iter().filter(|text| text.parse::<f64>().is_ok()).collect();
        assert!(labels.len() > 8, "{labels:?}");
        assert!(labels.iter().all(|label| label.len() <= 7), "from {start} s for {duration} s: {labels:?}");
    }
}

#[test]
fn names_beside_the_time_line_can_be_told_apart() {
    let body = |number: u32| {
        format!(
            "[[body]]\nname = \"long name of disc {number}\"\nshape = {{ disc = {{ radius = 0.1 }} }}\nmass = 1\nposition = [{number}, 0]\n"
        )
    };
    let (_, recording) = recorded(&(1..=3).map(body).collect::<String>());
    let picture = events_picture(&recording);
    for number in 1..=3 {
        assert!(
            picture.contains(&format!("… disc {number}</text>"))
                || picture.contains(&format!(" disc {number}</text>")),
            "{picture}"
        );
    }
    let place = |text: &str| {
        picture.find(text).map(|end| picture[..end].rfind(" y=\"").map(|start| &picture[start..end]))
    };
    let none = place("no impacts")
        .flatten()
        .and_then(|text| attribute(text, "y").next())
        .and_then(|y| y.parse::<f64>().ok());
    assert!(
        none.is_some_and(|y| (HEAD + 9.0..HEAD + 12.0).contains(&y)),
        "below the frame, above the first lane: {none:?}"
    );
}

/// A scene to look at, run for two seconds.
fn looked_at(name: &str) -> (World, Recording) {
    let path = format!("{}/../../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::read(path).unwrap_or_else(|error| panic!("{error}"));
    scene.set_duration(2.0, "the test").expect("a duration");
    let mut world = World::from_scene(&scene).unwrap_or_else(|error| panic!("{error}"));
    let report = run(&mut world, &RunPlan::of_scene(&scene, Record::Everything), &mut unwatched);
    (world, report.recording)
}

#[test]
fn no_line_of_a_body_with_its_centre_of_mass_outside_of_it_is_cut_off() {
    let (world, recording) = looked_at("graham_escapement");
    let pictures = ScenePictures::new(&world, &recording);
    for frame in recording.frames.iter().step_by(40) {
        let picture = pictures.at(frame);
        let [width, height] = size_of(&picture);
        // The lines that show the angles of the bodies.
        let points = points_of(&picture, "#22272b\" stroke-width=\"1\"");
        assert_eq!(points.len(), 4);
        for [x, y] in points {
            assert!((0.0..=width).contains(&x) && (HEAD..=height - FOOT).contains(&y), "({x}, {y})");
        }
    }
}

/// Boxes around the names in a picture: left, right, top and bottom [px].
fn names_in(picture: &str) -> Vec<(String, [f64; 4])> {
    let drawn = picture.split("<g paint-order=").nth(1).and_then(|rest| rest.split("</g>").next());
    let lines = drawn.expect("a group of names").lines().filter(|line| line.starts_with("<text"));
    let number =
        |line: &str, name: &str| attribute(line, name).next().and_then(|value| value.parse::<f64>().ok());
    lines
        .map(|line| {
            let name = line.split('>').nth(1).and_then(|rest| rest.split('<').next()).unwrap_or_default();
            let (x, y) = number(line, "x").zip(number(line, "y")).expect("a place");
            let half = 0.5 * 7.2 * name.chars().count() as f64;
            (name.to_owned(), [x - half, x + half, y - 9.0, y + 3.0])
        })
        .collect()
}

#[test]
fn bodies_carry_their_names_where_there_is_room() {
    for (scene, count) in
        [("heap_of_discs", 28), ("pendulum_and_blocks", 6), ("graham_escapement", 2), ("four_bar", 3)]
    {
        let (world, recording) = looked_at(scene);
        let picture = ScenePictures::new(&world, &recording).at(recording.frames.last().expect("a frame"));
        let [width, height] = size_of(&picture);
        let names = names_in(&picture);
        assert_eq!(names.len(), count, "{scene}: {names:?}");
        for (index, (name, [left, right, top, bottom])) in names.iter().enumerate() {
            assert!(
                *left >= 0.0 && *right <= width && *top >= HEAD && *bottom <= height - FOOT,
                "{scene}: {name}"
            );
            for (other, [other_left, other_right, other_top, other_bottom]) in &names[..index] {
                let meets =
                    left < other_right && right > other_left && top < other_bottom && bottom > other_top;
                assert!(!meets, "{scene}: {name} meets {other}");
            }
        }
    }
}

#[test]
fn in_a_crowd_a_name_that_has_no_room_is_left_out() {
    let ball = |x: f64, name: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nshape = {{ disc = {{ radius = 0.5 }} }}\nmass = 1.0\nposition = [{x:?}, 0.0]\n"
        )
    };
    let row: String =
        (0..40).map(|index| ball(f64::from(index), &format!("quite a long name, {index}"))).collect();
    let names = names_in(&last_picture(&row));
    assert!((1..40).contains(&names.len()), "{names:?}");
}

#[test]
fn a_name_does_not_cover_a_body_that_is_too_late_for_a_name() {
    let disc = |name: &str, radius: f64, x: f64, y: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nshape = {{ disc = {{ radius = {radius:?} }} }}\nmass = 1.0\n\
             position = [{x:?}, {y:?}]\n"
        )
    };
    let row = (0..450).map(|index| disc(&format!("{index}"), 0.01, 6.0 + 0.03 * f64::from(index), 0.0));
    let crowd: String = std::iter::once(disc("big", 5.0, 0.0, 0.0)).chain(row).collect();
    // It lies where the name of the first body would be.
    let late = disc("late", 0.5, 0.0, -2.5) + "passes_through = [\"big\"]\n";
    let place = |parts: &str| {
        let picture = last_picture(parts);
        picture.lines().find(|line| line.ends_with(">big</text>")).map(str::to_owned)
    };
    let [alone, covered] = [&crowd, &(crowd.clone() + &late)].map(|parts| place(parts));
    assert!(alone.is_some() && alone != covered, "{alone:?}, {covered:?}");
}

#[test]
fn a_picture_says_which_part_of_the_paths_it_shows() {
    let (world, recording) = recorded(BOB);
    let pictures = ScenePictures::new(&world, &recording);
    let told = |index: usize| texts(&pictures.at(&recording.frames[index])).join("\n");
    let last = recording.frames.len() - 1;
    assert!(told(0).contains("t = 0 s; paths to come"), "{}", told(0));
    assert!(told(last / 2).contains("s; whole paths"), "{}", told(last / 2));
    assert!(told(last).contains("s; paths up to here"), "{}", told(last));
    let wide = format!(
        "{BOB}{}",
        BOB.split("[[force]]").next().unwrap_or_default().replace("bob", "other").replace("[0.0,", "[9.0,")
    );
    let (world, recording) = recorded(&wide.replacen("[[body]]", "[[body]]\nvelocity = [1.0, 0.0]", 1));
    let start = ScenePictures::new(&world, &recording).at(&recording.frames[0]);
    assert!(
        texts(&start).join("\n").contains("; thin lines: the paths of the centres of mass that are to come"),
        "{start}"
    );
    let still = BOB.split("[[force]]").next().unwrap_or_default();
    assert!(!last_picture(still).contains("paths"), "nothing moves");
}

#[test]
fn the_energy_plot_shows_what_changes_and_says_what_it_leaves_out() {
    let (_, recording) = looked_at("graham_escapement");
    let picture = energy_picture(&recording);
    let named = |picture: &str| {
        texts(picture).into_iter().find(|text| text.starts_with("energy [")).map(str::to_owned)
    };
    let label = named(&picture).expect("a name");
    assert!(
        label.starts_with("energy [J], without -15.5") && label.ends_with(" J of the potential energy"),
        "{label}"
    );
    // Each curve covers a good part of the plot, which is 320 px high.
    for color in ["#d9822b", "#3b6fb6"] {
        let heights: Vec<f64> =
            points_of(&picture, color).into_iter().map(|[_, y]| y).filter(|y| *y > HEAD).collect();
        let [low, high] = [f64::min, f64::max].map(|of| heights.iter().copied().reduce(of).expect("points"));
        assert!(high - low > 200.0, "{color}: {low} to {high}");
    }
    // A kinetic energy that hardly changes is left out too; what does not change at all is shown as it is.
    let (_, recording) = looked_at("geneva_drive");
    assert!(
        named(&energy_picture(&recording)).is_some_and(|label| label.ends_with(" J of the kinetic energy"))
    );
    let (_, recording) = looked_at("sinai_billiard");
    assert_eq!(named(&energy_picture(&recording)).as_deref(), Some("energy [J]"));
}
