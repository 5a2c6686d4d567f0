//! The free coordinate of a joint, and the rows of angles alone.
//!
//! A row of angles has no point at which its force acts: it is a torque, and its normal is zero. With a lever l its gap is
//! l (sum of coefficients times angles - constant), a length as all gaps are, and its force times l a torque. Rates are
//! constant sums of angular velocities, so that gamma is 0. Angles count whole turns, also those that were taken out of them.

use super::measure::slot_row;
use super::row::ConnectorSample;
use super::{Anchor, SlotFrame};
use crate::body::BodyId;
use crate::kinematics::GapKinematics;
use crate::motion::{BodyState, Moving};
use glam::DVec2;
use std::f64::consts::TAU;

/// Difference [rad] between a full turn 2π and [`TAU`], the nearest floating-point number.
const TAU_REST: f64 = 2.449_293_598_294_706_4e-16;

/// The free coordinate of two bodies that a joint ties together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum Coordinate {
    /// The angle [rad] of body b less that of body a, whole turns counted.
    Angle {
        /// Body a.
        a: BodyId,
        /// Body b.
        b: BodyId,
        /// Length [m] by which the rows of the coordinate are made lengths; it changes no motion, only what counts as
        /// little.
        lever: f64,
    },
    /// The displacement [m] of a point of body b from one of body a along a direction.
    Along {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Direction, a unit vector in `frame`.
        axis: DVec2,
        /// Frame of the direction.
        frame: SlotFrame,
    },
}

impl Coordinate {
    /// The angle of body b less that of body a, with a lever of 1 m.
    #[must_use]
    #[inline]
    pub fn angle(a: BodyId, b: BodyId) -> Self {
        Self::Angle { a, b, lever: 1.0 }
    }

    /// Ids of bodies a and b.
    #[must_use]
    #[inline]
    pub fn bodies(&self) -> [BodyId; 2] {
        match self {
            Self::Angle { a, b, .. } => [*a, *b],
            Self::Along { a, b, .. } => [a.body, b.body],
        }
    }

    /// Gap [m] of a row per unit of the coordinate: the lever of an angle, else 1.
    #[must_use]
    #[inline]
    pub fn scale(&self) -> f64 {
        match self {
            Self::Angle { lever, .. } => *lever,
            Self::Along { .. } => 1.0,
        }
    }

    /// Value [rad or m] between two bodies in given states, whose angles count whole turns.
    #[must_use]
    pub fn value(&self, states: [&BodyState; 2]) -> f64 {
        let [a, b] = states.map(Moving::from);
        self.measure([&a, &b]).gap / self.scale()
    }

    /// The row whose gap is the coordinate itself, as a length, between two bodies whose angles count whole turns.
    #[must_use]
    pub fn measure(&self, movings: [&Moving; 2]) -> ConnectorSample {
        self.row(1.0, 0.0, movings, [0.0; 2])
    }

    /// Measures the row whose gap is `sign` times the coordinate less `at`, as a length.
    #[inline]
    pub(super) fn row(&self, sign: f64, at: f64, movings: [&Moving; 2], turns: [f64; 2]) -> ConnectorSample {
        match self {
            Self::Angle { lever, .. } => {
                let scale = sign * lever;
                turning_row([-scale, scale], movings, turns, scale * at)
            }
            Self::Along { a, b, axis, frame } => {
                let mut sample = slot_row([a, b], movings, *axis * -sign, *frame);
                sample.gap -= sign * at;
                sample
            }
        }
    }
}

/// The row of a torque: its gap is a sum of the angles of both bodies times coefficients [m], less a constant [m].
#[inline]
pub(super) fn turning_row(
    coefficients: [f64; 2],
    movings: [&Moving; 2],
    turns: [f64; 2],
    constant: f64,
) -> ConnectorSample {
    let sum = |values: [f64; 2]| coefficients[0] * values[0] + coefficients[1] * values[1];
    let [a, b] = coefficients;
    let kinematics = GapKinematics {
        rate: sum(movings.map(|moving| moving.angular_velocity)),
        jacobian: [0.0, 0.0, a, 0.0, 0.0, b],
        gamma: 0.0,
        normal_rate: DVec2::ZERO,
        center_velocity: DVec2::ZERO,
    };
    let [point_a, point_b] = movings.map(|moving| moving.pose.position);
    let gap = (sum(movings.map(|moving| moving.angle)) - constant) + in_turns(sum(turns));
    ConnectorSample { gap, normal: DVec2::ZERO, point_a, point_b, kinematics }
}

/// What whole turns are worth in radians.
pub(super) fn in_turns(turns: f64) -> f64 {
    turns * TAU + turns * TAU_REST
}
