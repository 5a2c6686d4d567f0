//! Two features of moving bodies, of all kinds of pairs.

use crate::path::{Path, any_path, any_vector};
use glam::DVec2;
use halfgap_collision::{Arms, GapKinematics};
use halfgap_geometry::{DirectionRange, Feature, GapSample, LineFeature, RoundFeature};
use proptest::prelude::*;

/// Two features and the paths of their bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) features: [Feature; 2],
    pub(crate) paths: [Path; 2],
}

impl Case {
    pub(crate) fn sample(&self, t: f64) -> GapSample {
        let [a, b] = self.paths.map(|path| path.at(t).pose);
        GapSample::measure(&self.features[0], &a, &self.features[1], &b).expect("a pair that can touch")
    }

    /// The primary side and the normal side.
    pub(crate) fn sides(&self) -> [Path; 2] {
        let [a, b] = self.paths;
        if self.sample(0.0).primary_is_a { [a, b] } else { [b, a] }
    }

    pub(crate) fn kinematics(&self) -> GapKinematics {
        let [primary, normal] = self.sides().map(|path| path.at(0.0));
        GapKinematics::of(&self.sample(0.0), &primary, &normal)
    }

    /// Size of the terms of which rate and acceleration are sums: [m/s] and [m/s^2].
    pub(crate) fn scales(&self) -> [f64; 2] {
        let sample = self.sample(0.0);
        let [primary, normal] = self.sides();
        let moments = [primary.at(0.0), normal.at(0.0)];
        let arms = Arms::of(&sample, &moments[0], &moments[1]);
        let (mut speed, mut push) = (0.0, 0.0);
        for (path, arm) in [(primary, arms.primary), (normal, arms.normal)] {
            speed += path.velocity.length() + path.spin.abs() * arm.length();
            push += path.push.linear.length() + (path.push.angular.abs() + path.spin.powi(2)) * arm.length();
        }
        let distance = (sample.center_primary - sample.center_normal).length();
        [speed, push + speed * (normal.spin.abs() + speed / distance)]
    }
}

pub(crate) fn round(center: DVec2, radius: f64) -> Feature {
    Feature::Round(RoundFeature { center, radius, range: DirectionRange::Full })
}

pub(crate) fn line(angle: f64, offset: f64) -> Feature {
    let normal = DVec2::from_angle(angle);
    Feature::Line(LineFeature { normal, direction: normal.perp(), offset, start: -1.0, end: 1.0 })
}

/// Kinds of pairs.
pub(crate) const KINDS: usize = 7;

/// The seven kinds of pairs; the numbers give the places of the features in their bodies.
pub(crate) fn features(kind: usize, centers: [DVec2; 2], [small, size, angle]: [f64; 3]) -> [Feature; 2] {
    let [a, b] = centers;
    match kind {
        0 => [round(a, 0.0), round(b, 0.0)],
        1 => [round(a, 0.0), round(b, size)],
        2 => [round(a, 0.0), round(b, -size)],
        3 => [round(a, small), round(b, size)],
        4 => [round(a, small), round(b, -size)],
        5 => [round(a, 0.0), line(angle, size)],
        _ => [round(a, small), line(angle, size)],
    }
}

pub(crate) fn any_case() -> impl Strategy<Value = Case> {
    (0..KINDS).prop_flat_map(case_of_kind)
}

/// Cases of one kind of pair.
pub(crate) fn case_of_kind(kind: usize) -> impl Strategy<Value = Case> {
    let numbers = [0.1..0.5f64, 0.6..2.0f64, -3.2..3.2f64];
    let centers = prop::array::uniform2(any_vector(1.0));
    let case = (centers, numbers, prop::array::uniform2(any_path()), any::<bool>());
    case.prop_map(move |(centers, numbers, mut paths, swapped)| {
        let mut features = features(kind, centers, numbers);
        if swapped {
            features.reverse();
            paths.reverse();
        }
        Case { features, paths }
    })
    // Where centres meet the gap has a corner, and differences across it mean nothing.
    .prop_filter("the centres keep apart", |case| {
        let sample = case.sample(0.0);
        (sample.center_primary - sample.center_normal).length() > 0.8
    })
}
