//! Rate, Jacobian, gamma and normal rate of every row of every connector against finite differences of the gap itself.

use crate::differences::{first, second};
use crate::path::{Path, any_path, any_vector};
use glam::DVec2;
use halfgap_collision::{
    Anchor, BodyAcceleration, BodyId, Connector, ConnectorKind, ConnectorSample, Moving, RailPath, SlotFrame,
};
use halfgap_geometry::{EdgeSpec, Rotation};
use proptest::prelude::*;
use std::sync::Arc;

/// Tolerance of the differences below, relative to the scale of the terms; the formulas are exact.
const DIFFERENCE: f64 = 1e-8;
/// Steps [s] of the differences, at which rounding and truncation stay below the tolerance: order 8, h^8 against
/// eps/h^2.
const STEP: f64 = 0.004;
/// Kinds of cases.
const KINDS: usize = 16;

const STILL: Path = Path {
    position: DVec2::ZERO,
    angle: 0.0,
    velocity: DVec2::ZERO,
    spin: 0.0,
    push: BodyAcceleration { linear: DVec2::ZERO, angular: 0.0 },
};

/// A row of a connector and the paths of its bodies.
#[derive(Clone)]
struct Case {
    connector: Connector,
    row: usize,
    paths: [Path; 2],
}

impl std::fmt::Debug for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = format!("{:?}", self.connector.kind);
        let short: String = name.chars().take(200).collect();
        write!(f, "{short}.., row {}, {:?}, {:?}", self.row, self.paths, self.sample(0.0))
    }
}

impl Case {
    fn sample(&self, t: f64) -> ConnectorSample {
        let [a, b] = self.paths.map(|path| path.at(t));
        self.connector.measure(self.row, &a, &b)
    }

    /// Size of the terms of which rate and acceleration are sums: [m/s] and [m/s^2].
    fn scales(&self) -> [f64; 2] {
        let [a, b] = self.anchor_distances();
        let (mut speed, mut push, mut spin) = (0.0, 0.0, 0.0);
        for (path, arm) in self.paths.iter().zip([a, b]) {
            speed += path.velocity.length() + path.spin.abs() * arm;
            push += path.push.linear.length() + (path.push.angular.abs() + path.spin.powi(2)) * arm;
            spin += path.spin.abs();
        }
        [speed, push + speed * (spin + 4.0 * speed)]
    }

    /// Largest distances [m] from the centres of mass at which the row may act.
    fn anchor_distances(&self) -> [f64; 2] {
        let sample = self.sample(0.0);
        let apart = (self.paths[0].position - self.paths[1].position).length();
        let [a, b] = self.connector.anchors();
        let a = a.expect("it has a point");
        let arm_b = b.map_or(sample.point_b.length(), |b| b.point.length());
        [a.point.length() + apart + arm_b, a.point.length() + apart + arm_b]
    }

    /// True if the gap is smooth over the differences, at a place where its terms are not large.
    fn is_smooth(&self) -> bool {
        // The gap of a stop on a closed rail jumps by a lap somewhere.
        let [first, last] = [-4.0 * STEP, 4.0 * STEP].map(|t| self.sample(t).gap);
        (last - first).abs() < 0.5 && self.has_smooth_curve()
    }

    fn has_smooth_curve(&self) -> bool {
        let [a, b] = [-4.0 * STEP, 4.0 * STEP].map(|t| {
            let on_a = self.paths[0]
                .at(t)
                .pose
                .point_to_world(self.connector.anchors()[0].expect("it has a point").point);
            let places = self.connector.path().map(|path| path.nearest(on_a, None));
            (on_a, places)
        });
        match (a.1, b.1) {
            (Some(first), Some(last)) => {
                // At its ends a natural spline has a continuous curvature, but no continuous derivative of it.
                let ends = [0.0, self.connector.path().map_or(0.0, |path| path.length())];
                let room = |place: &halfgap_collision::RailPlace| 1.0 - place.curvature() * place.gap();
                first.piece() == last.piece()
                    && ends.map(|end| first.arc_length < end) == ends.map(|end| last.arc_length < end)
                    && room(&first) > 0.7
                    && room(&last) > 0.7
                    && first.gap().abs() < 0.3
            }
            _ => match &self.connector.kind {
                ConnectorKind::Rod { .. } | ConnectorKind::Rope { .. } => {
                    let sample = self.sample(0.0);
                    (sample.point_a - sample.point_b).length() > 0.8
                }
                _ => true,
            },
        }
    }
}

fn circle(clockwise: bool) -> RailPath {
    let start = DVec2::new(2.0, 0.3);
    let edges = [EdgeSpec::Arc { to: start, center: DVec2::new(0.1, 0.2), clockwise }];
    RailPath::from_edges(start, &edges).expect("a fine circle")
}

fn line() -> RailPath {
    let edges = [EdgeSpec::Line { to: DVec2::new(3.0, 1.0) }];
    RailPath::from_edges(DVec2::new(-3.0, -2.0), &edges).expect("a fine line")
}

fn bean() -> RailPath {
    let points = [(2.0, 0.0), (1.2, 1.4), (-0.4, 0.9), (-2.0, 1.2), (-1.8, -0.8), (0.3, -1.5)];
    RailPath::through(&points.map(DVec2::from), true).expect("a fine bean")
}

fn wave() -> RailPath {
    let points = [(-3.0, 0.0), (-1.5, 0.8), (0.2, -0.6), (1.4, 0.5), (3.0, 0.2)];
    RailPath::through(&points.map(DVec2::from), false).expect("a fine wave")
}

fn connector(kind: usize, points: [DVec2; 2], angle: f64) -> (Connector, usize) {
    let [a, b] = [(0, points[0]), (1, points[1])].map(|(id, point)| Anchor { body: BodyId(id), point });
    let (normal, length) = (DVec2::from_angle(angle), 1.5);
    let stop = |path: RailPath, upper| ConnectorKind::RailStop { a, path: Arc::new(path), at: 1.0, upper };
    let rail = |path: RailPath| ConnectorKind::Rail { a, path: Arc::new(path) };
    let slot = |frame| ConnectorKind::Slot { a, b, normal, frame };
    let (kind, row) = match kind {
        0 => (ConnectorKind::Pin { a, b }, 0),
        1 => (ConnectorKind::Pin { a, b }, 1),
        2 => (slot(SlotFrame::A), 0),
        3 => (slot(SlotFrame::B), 0),
        4 => (slot(SlotFrame::World), 0),
        5 => (ConnectorKind::Rod { a, b, length }, 0),
        6 => (ConnectorKind::Rope { a, b, length }, 0),
        7 => (rail(line()), 0),
        8 => (rail(circle(false)), 0),
        9 => (rail(circle(true)), 0),
        10 => (rail(bean()), 0),
        11 => (rail(wave()), 0),
        12 => (stop(line(), false), 0),
        13 => (stop(circle(true), true), 0),
        14 => (stop(bean(), false), 0),
        _ => (stop(wave(), true), 0),
    };
    (Connector::new(kind, 0.5).expect("a fine connector"), row)
}

fn any_case() -> impl Strategy<Value = Case> {
    let points = prop::array::uniform2(any_vector(1.0));
    let case = (0..KINDS, points, -3.2..3.2f64, prop::array::uniform2(any_path()));
    case.prop_map(|(kind, points, angle, paths)| {
        let (connector, row) = connector(kind, points, angle);
        let paths = if connector.path().is_some() { [paths[0], STILL] } else { paths };
        Case { connector, row, paths }
    })
    .prop_filter("the gap is smooth", Case::is_smooth)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4000, failure_persistence: None, max_global_rejects: 100_000, ..ProptestConfig::default()
    })]

    #[test]
    fn the_rate_is_the_derivative_of_the_gap(case in any_case()) {
        let difference = first(|t| case.sample(t).gap, STEP);
        let rate = case.sample(0.0).kinematics.rate;
        prop_assert!((rate - difference).abs() <= DIFFERENCE * case.scales()[0].max(1.0), "{} {}", rate, difference);
    }

    #[test]
    fn the_jacobian_is_the_derivative_of_the_rate_by_each_velocity(case in any_case()) {
        let kinematics = case.sample(0.0).kinematics;
        // The path of a rail is fixed: its columns are the reaction on the background.
        let columns = if case.connector.path().is_some() { 3 } else { 6 };
        for k in 0..columns {
            let mut paths = case.paths.map(|path| Path { velocity: DVec2::ZERO, spin: 0.0, push: STILL.push, ..path });
            let moved = &mut paths[k / 3];
            match k % 3 {
                0 => moved.velocity.x = 1.0,
                1 => moved.velocity.y = 1.0,
                _ => moved.spin = 1.0,
            }
            let alone = Case { paths, ..case.clone() };
            prop_assume!(alone.is_smooth());
            let difference = first(|t| alone.sample(t).gap, STEP);
            let scale = alone.scales()[0].max(1.0);
            prop_assert!((kinematics.jacobian[k] - difference).abs() <= DIFFERENCE * scale, "entry {}", k);
        }
    }

    #[test]
    fn the_rate_is_the_jacobian_times_the_velocities(case in any_case()) {
        let [a, b] = case.paths;
        let velocities = [a.velocity.x, a.velocity.y, a.spin, b.velocity.x, b.velocity.y, b.spin];
        let kinematics = case.sample(0.0).kinematics;
        let product: f64 = (0..6).map(|k| kinematics.jacobian[k] * velocities[k]).sum();
        prop_assert!((kinematics.rate - product).abs() <= 1e-14 * case.scales()[0]);
    }

    #[test]
    fn the_acceleration_is_the_second_derivative_of_the_gap(case in any_case()) {
        let difference = second(|t| case.sample(t).gap, STEP);
        let found = case.sample(0.0).kinematics.acceleration(&case.paths[0].push, &case.paths[1].push);
        let scale = case.scales()[1].max(1.0);
        prop_assert!((found - difference).abs() <= DIFFERENCE * scale, "{} against {}", found, difference);
    }

    #[test]
    fn the_normal_rate_is_the_derivative_of_the_normal(case in any_case()) {
        let difference = first(|t| case.sample(t).normal, STEP);
        let scale = case.scales()[0].max(1.0);
        prop_assert!((case.sample(0.0).kinematics.normal_rate - difference).length() <= DIFFERENCE * scale);
    }

    #[test]
    fn the_forces_act_along_the_normal_at_the_points(case in any_case()) {
        let sample = case.sample(0.0);
        let stretch = DVec2::new(sample.kinematics.jacobian[0], sample.kinematics.jacobian[1]).length();
        let [a, b] = case.paths.map(|path| path.position);
        let torque = |point: DVec2, center: DVec2| (point - center).perp_dot(sample.normal) * stretch;
        prop_assert!((sample.normal.length() - 1.0).abs() < 1e-14);
        prop_assert!((sample.kinematics.jacobian[2] - torque(sample.point_a, a)).abs() < 1e-13 * stretch.max(1.0));
        prop_assert!((sample.kinematics.jacobian[5] + torque(sample.point_b, b)).abs() < 1e-13 * stretch.max(1.0));
    }

    #[test]
    fn the_world_may_be_turned(case in any_case(), angle in -3.2..3.2f64, shift in any_vector(3.0)) {
        // The two rows of a pin are those of the world's axes, and rails are fixed in it.
        prop_assume!(!matches!(case.connector.kind, ConnectorKind::Pin { .. }) && case.connector.path().is_none());
        let turn = Rotation::from_angle(angle);
        let turned = |path: Path| Path {
            position: turn.apply(path.position) + shift,
            angle: path.angle + angle,
            velocity: turn.apply(path.velocity),
            ..path
        };
        let mut connector = case.connector.clone();
        if let ConnectorKind::Slot { normal, frame: SlotFrame::World, .. } = &mut connector.kind {
            *normal = turn.apply(*normal);
        }
        let other = Case { connector, paths: case.paths.map(turned), ..case.clone() };
        let (before, after) = (case.sample(0.0), other.sample(0.0));
        let scale = case.scales()[1].max(8.0);
        prop_assert!((before.gap - after.gap).abs() < 1e-14 * scale);
        prop_assert!((turn.apply(before.normal) - after.normal).length() < 1e-14 * scale);
        prop_assert!((before.kinematics.rate - after.kinematics.rate).abs() < 1e-14 * scale);
        prop_assert!((before.kinematics.gamma - after.kinematics.gamma).abs() < 1e-14 * scale);
        for column in [2, 5] {
            let difference = before.kinematics.jacobian[column] - after.kinematics.jacobian[column];
            prop_assert!(difference.abs() < 1e-14 * scale);
        }
    }

    #[test]
    fn the_ends_may_be_swapped(case in any_case()) {
        let swapped = match case.connector.kind.clone() {
            ConnectorKind::Rod { a, b, length } => ConnectorKind::Rod { a: b, b: a, length },
            ConnectorKind::Rope { a, b, length } => ConnectorKind::Rope { a: b, b: a, length },
            ConnectorKind::Slot { a, b, normal, frame } => {
                let frame = match frame {
                    SlotFrame::A => SlotFrame::B,
                    SlotFrame::B => SlotFrame::A,
                    SlotFrame::World => SlotFrame::World,
                };
                ConnectorKind::Slot { a: b, b: a, normal: -normal, frame }
            }
            _ => return Ok(()),
        };
        let [a, b] = case.paths;
        let other = Case { connector: Connector { kind: swapped, ..case.connector }, paths: [b, a], ..case.clone() };
        let (before, after) = (case.sample(0.0), other.sample(0.0));
        let scale = case.scales()[1].max(8.0);
        prop_assert!((before.gap - after.gap).abs() < 1e-14 * scale);
        prop_assert!((before.normal + after.normal).length() < 1e-14 * scale);
        prop_assert!((before.kinematics.gamma - after.kinematics.gamma).abs() < 1e-14 * scale);
        for k in 0..6 {
            let difference = before.kinematics.jacobian[k] - after.kinematics.jacobian[(k + 3) % 6];
            prop_assert!(difference.abs() < 1e-14 * scale);
        }
    }
}

#[test]
fn a_slot_that_turns_carries_its_point_outwards() {
    // The point of a runs along a slot of b that turns at 2 rad/s: 3 m out, moving outwards at 5 m/s.
    let [a, b] = [0, 1].map(|id| Anchor { body: BodyId(id), point: DVec2::ZERO });
    let kind = ConnectorKind::Slot { a, b, normal: DVec2::Y, frame: SlotFrame::B };
    let slot = Connector::new(kind, 0.0).expect("a fine slot");
    let bead = Path { position: DVec2::X * 3.0, velocity: DVec2::new(5.0, 6.0), ..STILL };
    let arm = Path { spin: 2.0, ..STILL };
    let sample = slot.measure(0, &bead.at(0.0), &arm.at(0.0));
    assert_eq!((sample.gap, sample.kinematics.rate), (0.0, 0.0));
    // Coriolis: the bead needs a push of 2 w u.
    assert_eq!(sample.kinematics.gamma, -20.0);
}

#[test]
fn a_rope_whose_ends_meet_has_some_normal() {
    let [a, b] = [0, 1].map(|id| Anchor { body: BodyId(id), point: DVec2::ZERO });
    let rope = Connector::new(ConnectorKind::Rope { a, b, length: 2.0 }, 1.0).expect("a fine rope");
    let mover = Path { velocity: DVec2::new(0.3, -4.0), spin: 2.0, ..STILL };
    let sample = rope.measure(0, &mover.at(0.0), &STILL.at(0.0));
    assert_eq!((sample.gap, sample.normal, sample.kinematics.gamma), (2.0, DVec2::X, 0.0));
    assert_eq!(rope.error(&mover.at(0.0), &STILL.at(0.0), None), 0.0);
}

#[test]
fn a_bead_on_a_circle_is_pushed_to_its_middle() {
    let start = DVec2::new(2.0, 0.0);
    let edges = [EdgeSpec::Arc { to: start, center: DVec2::ZERO, clockwise: false }];
    let path = Arc::new(RailPath::from_edges(start, &edges).expect("a fine circle"));
    let a = Anchor { body: BodyId(0), point: DVec2::ZERO };
    let rail = Connector::new(ConnectorKind::Rail { a, path }, 0.0).expect("a fine rail");
    let bead = Path { position: DVec2::new(0.0, 2.0), velocity: DVec2::new(-3.0, 0.0), ..STILL };
    let sample = rail.measure(0, &bead.at(0.0), &Moving::BACKGROUND);
    assert_eq!((sample.gap, sample.normal), (0.0, DVec2::NEG_Y));
    assert_eq!(sample.kinematics.gamma, -4.5);
}
