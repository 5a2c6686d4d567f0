//! Billiards of one disc, fully elastic: in a square, about a round scatterer (Sinai), in a stadium (Bunimovich).
//!
//! The square is unfolded in closed form. The two others magnify errors by a factor at each bounce off a
//! curve, so their answers are traced in numbers of 31 digits; how much a nudge of the start grows tells what
//! they are good to.

use crate::reference::double_double::Double;
use crate::scene::{Body, Check, Scene, Shape};
use glam::DVec2;
use halfgap::BodyState;
use halfgap::geometry::{EdgeSpec, PathSpec};

/// Radius of the moving disc [m].
const DISC: f64 = 0.125;
/// How far a start is nudged to see how errors grow [m].
const NUDGE: f64 = 1e-25;

pub(super) fn square() -> Scene {
    // Room for the centre: [0, width] x [0, height].
    let (width, height, velocity) = (3.0, 2.0, DVec2::new(8.5, 5.2));
    let start = DVec2::new(0.5, 0.7);
    let fold = |x: f64, size: f64| {
        let lap = x.rem_euclid(2.0 * size);
        if lap < size { (lap, 1.0) } else { (2.0 * size - lap, -1.0) }
    };
    let check = |time: f64| {
        let ((x, right), (y, up)) =
            (fold(start.x + velocity.x * time, width), fold(start.y + velocity.y * time, height));
        let state = BodyState {
            position: DVec2::new(x, y),
            velocity: velocity * DVec2::new(right, up),
            ..BodyState::default()
        };
        Check { time, states: vec![(0, state)] }
    };
    let (low, high) = (DVec2::splat(-DISC), DVec2::new(width, height) + DISC);
    let mut bodies = vec![Body::disc("disc", DISC, 1.0, start, velocity)];
    bodies.extend(walls(low, high));
    Scene::new("square_billiard", "a disc in a box, 54 bounces in 10 s", bodies)
        .with_checks(0.5, vec![check(2.0), check(5.5), check(10.0)])
        .with_reference("closed form: the box unfolded", 1e-14)
}

pub(super) fn sinai() -> Scene {
    let (half, scatterer) = (1.0, 0.5);
    let (start, velocity) = (DVec2::new(-0.75, -0.625), DVec2::new(1.0, 0.375));
    let room = half - DISC;
    let table = Table {
        walls: [(DVec2::X, -room), (-DVec2::X, -room), (DVec2::Y, -room), (-DVec2::Y, -room)].to_vec(),
        circles: vec![Circle { center: DVec2::ZERO, radius: Double::sum(scatterer, DISC), ends: None }],
        walls_end: f64::INFINITY,
    };
    let mut bodies = vec![Body::disc("disc", DISC, 1.0, start, velocity)];
    bodies.extend(walls(DVec2::splat(-half), DVec2::splat(half)));
    bodies.push(Body::fixed("scatterer", Shape::Disc { radius: scatterer }, DVec2::ZERO));
    let scene = Scene::new("sinai_billiard", "a disc among four walls and a round scatterer", bodies);
    traced(scene, &table, start, velocity, &[2.0, 4.0, 6.0, 8.0])
}

pub(super) fn stadium() -> Scene {
    let (half, radius) = (1.0, 1.0);
    let (start, velocity) = (DVec2::new(0.25, 0.125), DVec2::new(1.5, 1.0));
    let room = radius - DISC;
    let circle = |side: f64| Circle {
        center: DVec2::new(side * half, 0.0),
        radius: Double::from(room),
        ends: Some(side),
    };
    let table = Table {
        walls: [(DVec2::Y, -room), (-DVec2::Y, -room)].to_vec(),
        circles: vec![circle(1.0), circle(-1.0)],
        walls_end: half,
    };
    let arc = |side: f64| EdgeSpec::Arc {
        to: DVec2::new(side * half, side * radius),
        center: DVec2::new(side * half, 0.0),
        clockwise: false,
    };
    let line = |x: f64, y: f64| EdgeSpec::Line { to: DVec2::new(x, y) };
    let inside = PathSpec {
        start: DVec2::new(-half, -radius),
        edges: vec![line(half, -radius), arc(1.0), line(-half, radius), arc(-1.0)],
    };
    let outside = DVec2::new(half + radius + 0.5, radius + 0.5);
    let corner = |x: f64, y: f64| DVec2::new(x, y) * outside;
    let outside =
        PathSpec::polygon(&[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
    let bodies = vec![
        Body::disc("disc", DISC, 1.0, start, velocity),
        Body::fixed("stadium", Shape::Outline(vec![outside, inside]), DVec2::ZERO),
    ];
    let scene =
        Scene::new("stadium_billiard", "a disc in a stadium of two lines and two half circles", bodies);
    traced(scene, &table, start, velocity, &[2.0, 4.0, 6.0, 8.0])
}

/// Four walls about the rectangle between two corners.
fn walls(low: DVec2, high: DVec2) -> Vec<Body> {
    let (size, middle, thick) = (high - low, 0.5 * (low + high), 0.5);
    let across = Shape::Block { width: size.x + 4.0 * thick, height: 2.0 * thick };
    let along = Shape::Block { width: 2.0 * thick, height: size.y };
    vec![
        Body::fixed("floor", across.clone(), DVec2::new(middle.x, low.y - thick)),
        Body::fixed("ceiling", across, DVec2::new(middle.x, high.y + thick)),
        Body::fixed("left", along.clone(), DVec2::new(low.x - thick, middle.y)),
        Body::fixed("right", along, DVec2::new(high.x + thick, middle.y)),
    ]
}

/// What the centre of the disc bounces off.
struct Table {
    /// Inner unit normal along an axis, and the coordinate along it at which the wall stands.
    walls: Vec<(DVec2, f64)>,
    circles: Vec<Circle>,
    /// Walls reach to this |x| only.
    walls_end: f64,
}

struct Circle {
    center: DVec2,
    radius: Double,
    /// Bounces inside, where x is further out than the centre on this side; else outside and all around.
    ends: Option<f64>,
}

type Point = [Double; 2];

fn dot(a: Point, b: Point) -> Double {
    a[0] * b[0] + a[1] * b[1]
}

fn along(from: Point, velocity: Point, time: Double) -> Point {
    [from[0] + velocity[0] * time, from[1] + velocity[1] * time]
}

impl Table {
    /// The next bounce: when, and with which direction of the normal.
    fn next(&self, from: Point, velocity: Point) -> Option<(Double, Point)> {
        let walls = self.walls.iter().filter_map(|&(normal, place)| {
            let normal = [Double::from(normal.x), Double::from(normal.y)];
            let closing = dot(normal, velocity);
            if closing.value() >= 0.0 {
                return None;
            }
            let time = (Double::from(place) - dot(normal, from)) / closing;
            let is_on = along(from, velocity, time)[0].value().abs() <= self.walls_end;
            is_on.then_some((time, normal))
        });
        let circles = self.circles.iter().filter_map(|circle| circle.hit(from, velocity));
        let ahead = walls.chain(circles).filter(|(time, _)| time.value() > 0.0);
        ahead.min_by(|a, b| a.0.value().total_cmp(&b.0.value()))
    }

    /// Place and velocity after a time.
    fn trace(&self, start: Point, velocity: Point, time: f64) -> (Point, Point) {
        let (mut place, mut velocity, mut left) = (start, velocity, Double::from(time));
        while let Some((bounce, normal)) = self.next(place, velocity) {
            if bounce >= left {
                break;
            }
            place = along(place, velocity, bounce);
            let factor = Double::from(-2.0) * dot(velocity, normal) / dot(normal, normal);
            velocity = along(velocity, normal, factor);
            left = left - bounce;
        }
        (along(place, velocity, left), velocity)
    }
}

impl Circle {
    fn hit(&self, from: Point, velocity: Point) -> Option<(Double, Point)> {
        let center = [Double::from(self.center.x), Double::from(self.center.y)];
        let offset = [from[0] - center[0], from[1] - center[1]];
        let (a, b) = (dot(velocity, velocity), dot(offset, velocity));
        let c = dot(offset, offset) - self.radius * self.radius;
        let discriminant = b * b - a * c;
        if discriminant.value() <= 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        // From inside the later root, from outside the earlier.
        let time = if self.ends.is_some() { (root - b) / a } else { (-b - root) / a };
        let normal = along(offset, velocity, time);
        let is_there = self.ends.is_none_or(|side| side * normal[0].value() > 0.0);
        let closes = dot(normal, velocity).value() * self.ends.map_or(1.0, |_| -1.0) < 0.0;
        (is_there && closes).then_some((time, normal))
    }
}

fn traced(scene: Scene, table: &Table, start: DVec2, velocity: DVec2, times: &[f64]) -> Scene {
    let exact = |vector: DVec2| [Double::from(vector.x), Double::from(vector.y)];
    let nudged = |mut point: Point| {
        point[0] = point[0] + Double::from(NUDGE);
        point
    };
    let mut growth = 0.0_f64;
    let check = |&time: &f64| {
        let (place, speed) = table.trace(exact(start), exact(velocity), time);
        let (other, _) = table.trace(nudged(exact(start)), exact(velocity), time);
        let apart = [other[0] - place[0], other[1] - place[1]];
        growth = growth.max(apart[0].value().hypot(apart[1].value()) / NUDGE);
        let value = |point: Point| DVec2::new(point[0].value(), point[1].value());
        let state = BodyState { position: value(place), velocity: value(speed), ..BodyState::default() };
        Check { time, states: vec![(0, state)] }
    };
    let checks = times.iter().map(check).collect();
    let how = format!("traced with 31 digits; a nudge of the start grows by {growth:.0}");
    scene.with_checks(0.5, checks).with_reference(&how, f64::EPSILON)
}
