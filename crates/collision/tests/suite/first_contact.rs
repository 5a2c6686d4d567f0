//! First contact against an oracle that shares nothing with it but the shapes: dense sampling of the distance between
//! outlines (edges as closed curves), refined where it comes near the target gap.

use crate::random::Random;
use glam::DVec2;
use halfgap_collision::{
    BodyState, FeatureRule, Flight, Motion, MovingShape, PairSearch, Search, SearchSettings, Tolerances,
    disc_contact, first_contact, search_step,
};
use halfgap_geometry::{EdgeSpec, Feature, FeatureId, PathSpec, Pose, Shape};

/// Number of pairs of bodies that are tried.
const PAIRS: u64 = 10_000;
/// Number of samples of a span before refinement.
const SAMPLES: u32 = 100;
/// A sampled least gap within this fraction of the scale from the target may count as a contact or not.
const UNDECIDED: f64 = 1e-10;

/// A crescent: a convex and a concave arc.
fn crescent() -> Shape {
    let (top, bottom) = (DVec2::new(0.0, 1.0), DVec2::new(0.0, -1.0));
    let edges = vec![EdgeSpec::Bulge { to: bottom, bulge: 1.0 }, EdgeSpec::Bulge { to: top, bulge: -0.5 }];
    Shape::from_paths(&[PathSpec { start: top, edges }]).expect("a fine crescent")
}

/// A block with a round bite out of its top.
fn cradle() -> Shape {
    let at = DVec2::new;
    let edges = vec![
        EdgeSpec::Line { to: at(1.0, -0.6) },
        EdgeSpec::Line { to: at(1.0, 0.4) },
        EdgeSpec::Line { to: at(0.6, 0.4) },
        EdgeSpec::Bulge { to: at(-0.6, 0.4), bulge: -0.7 },
        EdgeSpec::Line { to: at(-1.0, 0.4) },
        EdgeSpec::Line { to: at(-1.0, -0.6) },
    ];
    Shape::from_paths(&[PathSpec { start: at(-1.0, -0.6), edges }]).expect("a fine cradle")
}

fn shape(random: &mut Random, thin: bool) -> Shape {
    if thin {
        return Shape::block(random.between(0.5, 2.0), 1e-4).expect("a fine plate");
    }
    let built = match random.next() % 9 {
        0 => Shape::disc(random.between(0.2, 1.0)),
        1 => Shape::block(random.between(0.3, 2.0), random.between(0.3, 1.0)),
        2 => Shape::rounded_block(random.between(0.8, 2.0), 0.7, random.between(0.05, 0.35)),
        3 => Shape::regular_polygon(3 + (random.next() % 6) as usize, random.between(0.4, 1.0)),
        4 => Shape::capsule(random.between(0.9, 2.0), random.between(0.1, 0.4)),
        5 => Shape::sector(random.between(0.5, 1.0), random.between(0.5, 5.5)),
        6 => Shape::ring(1.0, random.between(0.5, 0.9)),
        7 => Ok(crescent()),
        _ => Ok(cradle()),
    };
    let built = built.expect("fine measures");
    // Half of the bodies are lopsided: their centre of mass is not where their symmetry is.
    let shift = if random.next().is_multiple_of(2) {
        random.direction() * random.between(0.0, 0.3)
    } else {
        DVec2::ZERO
    };
    built.translated(shift)
}

struct Case {
    a: (Shape, Flight),
    b: (Shape, Flight),
    span: f64,
    target: f64,
}

impl Case {
    /// Generates motions in which body a flies towards body b; every class of awkwardness gets its share.
    fn generate(random: &mut Random) -> Option<Self> {
        let class = random.next() % 6;
        let thin = class == 1;
        let (shape_a, shape_b) = (shape(random, thin), {
            let also = thin && random.next().is_multiple_of(2);
            shape(random, also)
        });
        let speed = match class {
            2 => 1e3,
            3 => random.one_of(&[10.0, 100.0, 1e3]),
            _ => random.one_of(&[0.1, 1.0, 10.0]),
        };
        let spin = |random: &mut Random| match class {
            3 => random.between(-1e3, 1e3),
            4 | 5 => 0.0,
            _ => random.one_of(&[0.0, 1.0]) * random.between(-3.0, 3.0) * speed,
        };
        let heading = random.direction();
        let reach = shape_a.reach() + shape_b.reach();
        let distance = random.between(1.05, 2.5) * reach;
        let target = random.one_of(&[1e-4, 1e-7, 1e-10]);
        let angle_b = random.between(-3.0, 3.0);
        let angle_a = if class == 5 {
            let quarter = std::f64::consts::FRAC_PI_2 * random.one_of(&[0.0, 1.0]);
            angle_b + random.one_of(&[0.0, 1e-9, 1e-6, -1e-7]) + quarter
        } else {
            random.between(-3.0, 3.0)
        };
        let miss = if class == 4 {
            // DeadPoints: a passes b with the target gap between their outermost points, or nearly.
            let across = |angle: f64, side: f64| DVec2::from_angle(-angle).rotate(heading.perp() * side);
            let widths = shape_a.extent(across(angle_a, -1.0)) + shape_b.extent(across(angle_b, 1.0));
            widths + target + random.one_of(&[-1e-4, -1e-7, -1e-10, -1e-13, 0.0, 1e-13, 1e-9, 1e-6])
        } else {
            random.between(-1.1, 1.1) * reach
        };
        let pull = if class == 4 { 0.0 } else { random.one_of(&[0.0, 0.0, 1.0]) };
        let gravity = random.direction() * (pull * speed * speed / reach);
        let rate = if class == 4 { 0.0 } else { random.one_of(&[0.0, 0.0, 0.3]) * speed / reach };
        let center = random.direction() * random.between(0.0, 10.0);
        let drift = random.direction() * (speed * random.one_of(&[0.0, 0.5]));
        let state_a = BodyState {
            position: center - heading * distance + heading.perp() * miss,
            angle: angle_a,
            velocity: heading * speed + drift,
            angular_velocity: spin(random),
        };
        let state_b =
            BodyState { position: center, angle: angle_b, velocity: drift, angular_velocity: spin(random) };
        let gravity_b = gravity * random.one_of(&[0.0, 1.0]);
        let case = Self {
            a: (shape_a, Flight::new(state_a, gravity, rate, rate)),
            b: (shape_b, Flight::new(state_b, gravity_b, 0.0, 0.0)),
            span: random.between(1.0, 2.0) * (distance + reach) / speed,
            target,
        };
        (case.height(0.0) > 1e-9).then_some(case)
    }

    /// Distance of the outlines less the target gap.
    fn height(&self, time: f64) -> f64 {
        let pose_a = self.a.1.moving_at(time).pose;
        let pose_b = self.b.1.moving_at(time).pose;
        self.a.0.distance(&pose_a, &self.b.0, &pose_b).distance - self.target
    }

    fn scale(&self) -> f64 {
        10.0 + self.a.0.reach() + self.b.0.reach()
    }

    /// Bound on how fast the distance changes.
    fn fastest(&self) -> f64 {
        let (a, b) = (self.a.1.bounds(0.0, self.span), self.b.1.bounds(0.0, self.span));
        a.velocity.largest_difference(&b.velocity)
            + a.angular_speed * self.a.0.reach()
            + b.angular_speed * self.b.0.reach()
    }

    fn found(&self) -> Option<f64> {
        let tolerances =
            Tolerances { target_gap: self.target, accuracy: 0.6 * self.target, velocity_tol: 1e-9 };
        let side_a = MovingShape { shape: &self.a.0, motion: &self.a.1, offset: 0.0 };
        let side_b = MovingShape { shape: &self.b.0, motion: &self.b.1, offset: 0.0 };
        match first_contact(&side_a, &side_b, self.span, &tolerances, &SearchSettings::default()) {
            Search::Contact(contact) => Some(contact.time),
            Search::NoneBefore(_) => None,
        }
    }
}

/// Result of sampling: the first time at or below the target, and the least height.
struct Sampled {
    first: Option<f64>,
    least: f64,
}

/// Samples in steps as long as the speed bound allows, at least a sample's length; refines where the height has a dip.
fn sample(case: &Case) -> Sampled {
    let fastest = case.fastest();
    let floor = (case.span / f64::from(SAMPLES)).min(0.02 * case.scale() / fastest);
    let mut sampled = Sampled { first: None, least: f64::INFINITY };
    let mut before: [(f64, f64); 2] = [(0.0, f64::INFINITY); 2];
    let mut time = 0.0;
    while time < case.span {
        let height = case.height(time);
        let [(t0, h0), (t1, h1)] = before;
        if h1 <= h0 && h1 <= height && h1 < fastest * (time - t0) {
            let (dip, depth) = lowest(case, t0, time);
            sampled.least = sampled.least.min(depth);
            if depth <= 0.0 {
                sampled.first = Some(crossing(case, t0, dip));
                return sampled;
            }
        }
        sampled.least = sampled.least.min(height);
        if height <= 0.0 {
            sampled.first = Some(crossing(case, t1, time));
            return sampled;
        }
        before = [(t1, h1), (time, height)];
        time += (height / fastest).max(floor);
    }
    sampled
}

/// Least height between two times, by golden section.
fn lowest(case: &Case, mut low: f64, mut high: f64) -> (f64, f64) {
    let ratio = 0.618_033_988_749_895;
    let mut best = (low, case.height(low));
    for _ in 0..60 {
        let (t1, t2) = (high - ratio * (high - low), low + ratio * (high - low));
        let (h1, h2) = (case.height(t1), case.height(t2));
        for candidate in [(t1, h1), (t2, h2)] {
            if candidate.1 < best.1 {
                best = candidate;
            }
        }
        if h1 < h2 { high = t2 } else { low = t1 }
    }
    best
}

/// The time at which the height crosses zero, by bisection between a time above and a time at or below zero.
fn crossing(case: &Case, mut above: f64, mut below: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (above + below);
        if case.height(middle) > 0.0 { above = middle } else { below = middle }
    }
    below
}

#[test]
fn no_contact_is_missed_and_none_invented() {
    let mut random = Random(20_261_121);
    let (mut tried, mut contacts, mut ill_conditioned, mut undecided) = (0, 0, 0, 0);
    while tried < PAIRS {
        let seed = random.0;
        let Some(case) = Case::generate(&mut random) else { continue };
        tried += 1;
        let (found, sampled) = (case.found(), sample(&case));
        let near = UNDECIDED * case.scale();
        match (found, sampled.first) {
            (None, None) => {}
            (Some(time), None) => {
                // Sampling may have stepped over a dip that the search found: then the height there is zero.
                let height = case.height(time);
                let is_real = height.abs() <= 1e-12 * case.scale();
                assert!(
                    is_real,
                    "seed {seed}: invented at {time} s, height {height}, least {}",
                    sampled.least
                );
                if sampled.least.abs() <= near { undecided += 1 } else { contacts += 1 }
            }
            (None, Some(time)) => {
                let around = 1e-3 * case.span;
                let (_, dip) = lowest(&case, (time - around).max(0.0), (time + around).min(case.span));
                assert!(dip >= -near, "seed {seed}: missed at {time} s, {dip} m deep");
                undecided += 1;
            }
            (Some(time), Some(expected)) => {
                contacts += 1;
                if (time - expected).abs() > 1e-9 * case.span {
                    ill_conditioned += 1;
                    // An earlier time must be a real contact that sampling stepped over; a later one is right
                    // only where the height is so flat that rounding moves its zero.
                    let deepest = if time > expected { lowest(&case, expected, time).1 } else { 0.0 };
                    let height = case.height(time).abs().max(-deepest);
                    assert!(
                        height <= 1e-12 * case.scale(),
                        "seed {seed}: found {time} s, sampled {expected} s, height {height}"
                    );
                }
            }
        }
    }
    println!(
        "{tried} pairs, {contacts} contacts, {ill_conditioned} with ill-conditioned times, {undecided} undecided"
    );
    assert!(contacts > PAIRS / 4, "only {contacts} of the pairs meet");
    assert!(undecided < PAIRS / 100, "{undecided} undecided pairs");
}

#[test]
fn nothing_is_proven_of_what_is_no_number() {
    let disc = Shape::disc(0.5).expect("a fine radius");
    let sound = Tolerances { target_gap: 1e-6, accuracy: 0.6e-6, velocity_tol: 1e-9 };
    let rest = Flight::fixed(DVec2::ZERO, 0.0);
    let damped = |position: DVec2, spin: f64, rate: f64, tolerances: &Tolerances| {
        let velocity = DVec2::new(-1.0, 0.0);
        let state = BodyState { position, velocity, angular_velocity: spin, ..BodyState::default() };
        let flight = Flight::new(state, DVec2::ZERO, 0.0, rate);
        let [a, b] = [&rest, &flight].map(|motion| MovingShape { shape: &disc, motion, offset: 0.0 });
        let settings = SearchSettings::default();
        let found = first_contact(&a, &b, 5.0, tolerances, &settings);
        assert_eq!(search_step(&a, &b, 0.0, 5.0, tolerances, &settings), found, "a search of one step");
        found
    };
    let search = |position, spin, tolerances: &Tolerances| damped(position, spin, 0.0, tolerances);
    let place = DVec2::new(3.0, 0.0);
    assert!(matches!(search(place, 0.0, &sound), Search::Contact(_)));
    let nothing = Search::NoneBefore(0.0);
    assert_eq!(search(DVec2::new(f64::NAN, 0.0), 0.0, &sound), nothing);
    assert_eq!(search(place, f64::INFINITY, &sound), nothing);
    // The states are finite, but no bound on the angular acceleration is.
    assert_eq!(damped(place, 1.0, f64::INFINITY, &sound), nothing);
    assert_eq!(search(place, 0.0, &Tolerances { target_gap: f64::NAN, ..sound }), nothing);
}

#[test]
fn a_speck_far_above_a_floor_is_searched_in_one_call() {
    // The first windows are as short as the time in which the speck falls its own size.
    let (floor, speck) =
        (Shape::block(10.0, 1.0).expect("a fine block"), Shape::disc(1e-9).expect("a fine radius"));
    let rest = Flight::fixed(DVec2::new(0.0, -0.5), 0.0);
    let state =
        BodyState { position: DVec2::new(0.0, 2.0), velocity: DVec2::new(1.0, 0.0), ..BodyState::default() };
    let fall = Flight::new(state, DVec2::new(0.0, -10.0), 0.0, 0.0);
    let side_a = MovingShape { shape: &floor, motion: &rest, offset: 0.0 };
    let side_b = MovingShape { shape: &speck, motion: &fall, offset: 0.0 };
    let tolerances = Tolerances { target_gap: 1e-12, accuracy: 0.6e-12, velocity_tol: 1e-9 };
    let search = search_step(&side_a, &side_b, 0.0, 1.0, &tolerances, &SearchSettings::default());
    let Search::Contact(found) = search else { panic!("{search:?}") };
    assert!((found.time - 0.4f64.sqrt()).abs() < 1e-9, "{found:?}");
}

/// The time [s] at which a disc of a given radius [m], which falls from half a metre above a height [m], first touches
/// a shape.
fn falls_onto(shape: &Shape, radius: f64, place: DVec2) -> Option<f64> {
    let disc = Shape::disc(radius).expect("a fine radius");
    let rest = Flight::fixed(DVec2::ZERO, 0.0);
    let position = place + DVec2::new(0.0, radius + 0.5);
    let state = BodyState { position, velocity: DVec2::NEG_Y, ..BodyState::default() };
    let fall = Flight::new(state, DVec2::ZERO, 0.0, 0.0);
    let side_a = MovingShape { shape: &disc, motion: &fall, offset: 0.0 };
    let side_b = MovingShape { shape, motion: &rest, offset: 0.0 };
    let tolerances = Tolerances { target_gap: 1e-8, accuracy: 6e-9, velocity_tol: 1e-9 };
    match first_contact(&side_a, &side_b, 1.0, &tolerances, &SearchSettings::default()) {
        Search::Contact(contact) => Some(contact.time),
        Search::NoneBefore(_) => None,
    }
}

#[test]
fn a_disc_does_not_fall_through_a_joint_of_two_lines_that_all_but_lie_on_one() {
    for turn in [1e-15, 1e-12, 1e-10, 5e-10, 9e-10, 1.1e-9, 1e-8] {
        let low = -0.5 * turn;
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, low], [0.0, 0.0], [-1.0, low]].map(DVec2::from);
        let roof = Shape::polygon(&corners).expect("a fine polygon");
        for radius in [1e-3, 0.5, 20.0] {
            let time = falls_onto(&roof, radius, DVec2::ZERO);
            assert!(time.is_some_and(|time| (time - 0.5).abs() < 2e-8), "{turn} {radius}: {time:?}");
        }
    }
}

#[test]
fn a_flat_arc_does_not_reach_beyond_the_round_corner_to_which_it_is_joined() {
    // A block a metre wide with crowned top and bottom; its round corners end at x = 0.5 + the corner's radius.
    for (crown, corner) in [(1e3, 1e-3), (1e5, 1e-3), (1e6, 1e-4), (1e4, 1e-6)] {
        let half = (0.5_f64 / crown).asin();
        let top = DVec2::new(0.5, 0.1);
        let center = top - corner * DVec2::new(half.sin(), half.cos());
        let side = center + DVec2::new(corner, 0.0);
        let bulges = [0.0, ((0.5 * std::f64::consts::PI - half) / 4.0).tan(), (half / 2.0).tan()];
        let ends = [(side, 0), (top, 1), (DVec2::new(-top.x, top.y), 2), (DVec2::new(-side.x, side.y), 1)];
        let edges = ends.iter().chain(&ends).enumerate().map(|(place, &(to, kind))| {
            let to = if place < ends.len() { to } else { -to };
            EdgeSpec::Bulge { to, bulge: bulges[kind] }
        });
        let spec = PathSpec { start: DVec2::new(side.x, -side.y), edges: edges.collect() };
        let block = Shape::from_paths(&[spec]).expect("a fine outline");
        let widest = block.bounds_at(&Pose::IDENTITY).max.x;
        assert!((widest - side.x).abs() < 1e-8, "{crown} {corner}: {widest} m, not {}", side.x);
        // Just beside it a small disc falls past.
        let beside = DVec2::new(side.x + 1e-4 + 2e-8, 0.1);
        assert_eq!(falls_onto(&block, 1e-4, beside), None, "{crown} {corner}");
        let above = falls_onto(&block, 1e-4, DVec2::new(0.45, 0.1));
        assert!(above.is_some_and(|time| time < 0.5), "{crown} {corner}: {above:?}");
    }
}

#[test]
fn a_rate_that_feeds_a_motion_counts_as_none() {
    let state = BodyState { velocity: DVec2::X, angular_velocity: 1.0, ..BodyState::default() };
    for rate in [-1.0, f64::NAN] {
        let moved = Flight::new(state, DVec2::ZERO, rate, rate).state_at(2.0);
        assert_eq!((moved.position, moved.angle), (DVec2::new(2.0, 0.0), 2.0));
    }
}

#[test]
fn a_rule_with_a_wider_gap_than_all_others_fires() {
    // A block 5 mm over a cradle hops by 1 mm/s: it turns back after 0.1 ms, above the gap at which other
    // features fire.
    let (floor, block) = (cradle(), Shape::block(0.2, 0.2).expect("a fine block"));
    let rest = Flight::fixed(DVec2::ZERO, 0.0);
    let state = BodyState {
        position: DVec2::new(0.8, 0.505),
        velocity: DVec2::new(0.0, 1e-3),
        angular_velocity: 1e-6,
        ..BodyState::default()
    };
    let hop = Flight::new(state, DVec2::new(0.0, -10.0), 0.0, 0.0);
    let side_a = MovingShape { shape: &floor, motion: &rest, offset: 0.0 };
    let side_b = MovingShape { shape: &block, motion: &hop, offset: 0.0 };
    let settings = SearchSettings::default();
    let wide = Tolerances { target_gap: 5.2e-3, accuracy: 3e-3, velocity_tol: 0.5 };
    let narrow = Tolerances { target_gap: 4.5e-3, ..wide };
    let Search::Contact(found) = first_contact(&side_a, &side_b, 1e-3, &wide, &settings) else {
        panic!("it turns back")
    };
    assert!((found.time - 1e-4).abs() < 1e-6, "{found:?}");
    let rules = [FeatureRule { features: [found.feature_a, found.feature_b], target: Some(5.2e-3) }];
    let search =
        PairSearch { a: &side_a, b: &side_b, tolerances: &narrow, settings: &settings, rules: &rules };
    assert_eq!(search.step(0.0, 1e-3), Search::Contact(found));
}

/// A disc leaves a corner of the ground slowly: by the time that it comes over the next side, it has sunk below the
/// target gap of that side, while the corner, which it touched before, fires later.
#[test]
fn a_disc_that_sinks_beside_a_side_touches_it_when_it_comes_upon_it() {
    let corners = [
        (22.56, -3.0),
        (22.56, 0.195_099_590_626_241_71),
        (22.52, 0.236_430_246_319_327_52),
        (22.48, 0.275_837_297_113_934_7),
        (22.44, 0.313_114_654_074_220_34),
        (22.44, -3.0),
    ];
    let ground = Shape::polygon(&corners.map(|(x, y)| DVec2::new(x, y))).expect("a fine ground");
    let disc = Shape::disc(0.2).expect("a fine radius");
    let is_tip =
        |feature: &Feature| matches!(feature, Feature::Round(round) if (round.center.x - 22.52).abs() < 1e-9);
    let tip = FeatureId::from_index(ground.features().iter().position(is_tip).expect("a corner"));
    let start = BodyState {
        position: DVec2::new(22.663_721_543_736_695, 0.375_524_882_916_058_2),
        velocity: DVec2::new(-0.820_236_665_705_321_2, 0.847_522_980_427_801_7),
        ..BodyState::default()
    };
    let (flight, rest) =
        (Flight::new(start, DVec2::new(0.0, -9.81), 0.0, 0.0), Flight::fixed(DVec2::ZERO, 0.0));
    let a = MovingShape { shape: &disc, motion: &flight, offset: 0.0 };
    let b = MovingShape { shape: &ground, motion: &rest, offset: 0.0 };
    let target = 8e-6;
    let tolerances = Tolerances { target_gap: target, accuracy: 1.2e-5, velocity_tol: 1e-2 };
    let settings = SearchSettings { depth: target + 2e-5, ..SearchSettings::default() };
    for lowered in [8e-6, 7.5e-6, 7e-6, 6.5e-6] {
        let rules = [FeatureRule { features: [FeatureId(0), tip], target: Some(lowered) }];
        let search = PairSearch { a: &a, b: &b, tolerances: &tolerances, settings: &settings, rules: &rules };
        let Search::Contact(contact) = search.step(0.0, 0.05) else { panic!("{lowered}: none") };
        let place = flight.state_at(contact.time).position;
        let gap = disc.distance(&Pose::new(place, 0.0), &ground, &Pose::IDENTITY).distance;
        assert!(gap > 0.0 && gap <= target + 1e-12, "{gap:e} at {contact:?}");
    }
}

#[test]
fn a_rule_with_a_gap_far_below_the_surface_fires_however_short_the_search() {
    // The corner of a block is 5 mm below a floor's surface and goes on into the floor, during the search by less than
    // that depth.
    let floor = Shape::block(4.0, 1.0).expect("a fine floor");
    let block = Shape::block(1.3, 0.1).expect("a fine block");
    let (tilt, speed, deep) = (-0.01_f64, 12.0, 5e-3);
    let lowest = 0.65 * tilt.sin().abs() + 0.05 * tilt.cos();
    let state = BodyState {
        position: DVec2::new(0.0, 0.5 + lowest - deep),
        angle: tilt,
        velocity: DVec2::new(0.0, -speed),
        angular_velocity: 1e-6,
    };
    let (rest, fall) = (Flight::fixed(DVec2::ZERO, 0.0), Flight::new(state, DVec2::ZERO, 0.0, 0.0));
    let side_a = MovingShape { shape: &floor, motion: &rest, offset: 0.0 };
    let side_b = MovingShape { shape: &block, motion: &fall, offset: 0.0 };
    let tolerances = Tolerances { target_gap: 1e-10, accuracy: 0.6e-10, velocity_tol: 1e-9 };
    let features = |shape: &Shape| (0..).map(FeatureId).take(shape.features().len()).collect::<Vec<_>>();
    let all = features(&floor).into_iter().flat_map(|a| features(&block).into_iter().map(move |b| [a, b]));
    let rules: Vec<FeatureRule> = all.map(|features| FeatureRule { features, target: Some(-6e-3) }).collect();
    // Windows only: there are more pairs than the search tries directly.
    let settings = SearchSettings { direct_pairs: 0, ..SearchSettings::default() };
    let search =
        PairSearch { a: &side_a, b: &side_b, tolerances: &tolerances, settings: &settings, rules: &rules };
    let Search::Contact(found) = search.step(0.0, 2e-4) else { panic!("it gets there") };
    assert!((found.time - 1e-3 / speed).abs() < 1e-9, "{found:?}");
}

#[test]
fn corners_that_come_out_past_each_other_at_no_distance_do_not_meet() {
    // A block falls along the side of a tower; all of it has passed the tower's lower end but its upper corner.
    let (tower, block) =
        (Shape::block(1.0, 4.0).expect("a fine tower"), Shape::block(1.0, 1.0).expect("a fine block"));
    let tolerances = Tolerances { target_gap: 1e-10, accuracy: 0.6e-10, velocity_tol: 1e-9 };
    let settings = SearchSettings::default();
    let corner = |shape: &Shape, wanted: DVec2| {
        let is_there = |feature: &Feature| matches!(feature, Feature::Round(round) if round.center == wanted);
        let place = shape.features().iter().position(is_there).expect("a corner");
        FeatureId(u32::try_from(place).expect("few features"))
    };
    let lower = corner(&tower, DVec2::new(0.5, -2.0));
    let upper = corner(&block, DVec2::new(-0.5, 0.5));
    let of = |shape: &Shape| (0..).map(FeatureId).take(shape.features().len()).collect::<Vec<_>>();
    let pairs = of(&tower).into_iter().flat_map(|a| of(&block).into_iter().map(move |b| [a, b]));
    let others = pairs.filter(|&features| features != [lower, upper]);
    let rules: Vec<FeatureRule> = others.map(|features| FeatureRule { features, target: None }).collect();
    for part in 0..200 {
        let turn = DVec2::from_angle(0.031 * f64::from(part));
        let (place, angle) = (turn.rotate(DVec2::new(1.0, -2.4)) + DVec2::new(2.7, -4.1), turn.to_angle());
        let start = BodyState { position: place, angle, ..BodyState::default() };
        let fall = Flight::new(start, turn.rotate(DVec2::new(0.0, -10.0)), 0.0, 0.0);
        let rest = Flight::fixed(DVec2::new(2.7, -4.1), angle);
        let side_a = MovingShape { shape: &tower, motion: &rest, offset: 0.0 };
        let side_b = MovingShape { shape: &block, motion: &fall, offset: 0.0 };
        let search = PairSearch {
            a: &side_a,
            b: &side_b,
            tolerances: &tolerances,
            settings: &settings,
            rules: &rules,
        };
        let mut from = 0.0;
        while from < 0.5 {
            let Search::NoneBefore(time) = search.step(from, 0.5) else {
                panic!("they meet, turned by {angle}")
            };
            assert!(time > from, "it goes on");
            from = time;
        }
    }
}

#[test]
fn two_discs_meet_to_the_bit_when_their_shapes_do() {
    let mut random = Random(7);
    let tolerances = Tolerances { target_gap: 1e-6, accuracy: 0.6e-6, velocity_tol: 1e-9 };
    let settings = SearchSettings::default();
    let mut meetings = 0;
    for _ in 0..PAIRS {
        let gravity = DVec2::new(0.3, random.one_of(&[0.0, -9.81]));
        let radii = [random.between(0.1, 1.0), random.between(0.1, 1.0)];
        // Some pairs touch already, with gaps up to a fifth below their target.
        let apart = radii[0] + radii[1] + random.one_of(&[0.8e-6, 1e-6, 1.1e-6, 0.5, 3.0]);
        let place = random.direction() * apart;
        let flights = [DVec2::ZERO, place].map(|position| {
            let velocity = random.direction() * random.between(0.0, 2.0);
            Flight::new(BodyState { position, velocity, ..BodyState::default() }, gravity, 0.0, 0.0)
        });
        let offset = random.one_of(&[0.0, 0.25]);
        let shapes = radii.map(|radius| Shape::disc(radius).expect("a fine radius"));
        let side = |index: usize| MovingShape { shape: &shapes[index], motion: &flights[index], offset };
        let general = first_contact(&side(0), &side(1), 5.0, &tolerances, &settings);
        let disc =
            |index: usize| (flights[index].polynomial_from(offset).expect("nothing damps it"), radii[index]);
        let special = disc_contact(disc(0), disc(1), 5.0, &tolerances);
        assert_eq!(special, Some(general));
        meetings += u32::from(matches!(general, Search::Contact(_)));
    }
    assert!(meetings > 500, "{meetings}");
}
