//! Rolling resistance at active contacts: the relative rotation of two bodies by the radius at which they roll on each other, and what resists it.
//!
//! With that radius R the rotation is a speed and the torque against it, over R, a force, bounded by the rolling resistance as friction is
//! by its coefficient. The rotation is the rate of R times the difference of both angles, which a contact that does not roll keeps.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::friction::{Axis, Grip};
use crate::rigid::contacts::rows::{ActiveRow, Mechanism, RowMoment, RowSource, mechanism, source_of};
use crate::rigid::surface::RowRolling;
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, GapKinematics, Moving, TangentRow, rolling_radius};
use halfgap_geometry::FeatureId;

impl Mechanism<'_> {
    /// Radius [m] at which two features roll on each other; `None` where they do not.
    pub(crate) fn rolling_radius(&self, (bodies, features): ([BodyId; 2], [FeatureId; 2])) -> Option<f64> {
        rolling_radius([0, 1].map(|side: usize| self.feature(bodies[side], features[side]).radius()))
    }

    /// The relative rotation at a contact.
    pub(crate) fn turning(
        &self,
        contact: ([BodyId; 2], [FeatureId; 2]),
        movings: [&Moving; 2],
    ) -> TangentRow {
        TangentRow::of_turning(self.rolling_radius(contact).unwrap_or(0.0), movings)
    }

    /// The coordinate [m] of a contact whose rate its relative rotation is.
    pub(crate) fn measure_turn(
        &self,
        contact: ([BodyId; 2], [FeatureId; 2]),
        movings: [&Moving; 2],
    ) -> RowMoment {
        let TangentRow { rate, jacobian, gamma } = self.turning(contact, movings);
        let still = DVec2::ZERO;
        let kinematics = GapKinematics { rate, jacobian, gamma, normal_rate: still, center_velocity: still };
        RowMoment { gap: jacobian[2] * (movings[0].angle - movings[1].angle), kinematics }
    }

    /// Rolling resistance at a contact's row, of which the force along the normal and, if it does not roll, that against rolling is given
    /// [N]; `None` where there is none.
    pub(crate) fn told_rolling(&self, row: &ActiveRow, normal: f64, along: f64) -> Option<RowRolling> {
        let RowSource::Contact(features) = row.source else { return None };
        let force = match row.grip(Axis::Turn) {
            Grip::Slips { side, coefficient, .. } => -side * coefficient * normal,
            Grip::Sticks { .. } => along,
            Grip::Smooth | Grip::Anchor { .. } | Grip::Bounded { .. } => return None,
        };
        let radius = self.rolling_radius((row.bodies, features))?;
        Some(RowRolling { moment: radius * force, radius })
    }
}

/// The relative rotation at a contact's record, as the bodies move now, and the rolling resistance [-]; `None` for other rows, and where
/// there is none.
pub(crate) fn turn_of(
    assembly: &Assembly,
    connectors: &Connectors,
    record: &Collision,
) -> Option<(TangentRow, f64)> {
    let RowSource::Contact(features) = source_of(record)? else { return None };
    let (bodies, mechanism) = (record.bodies(), mechanism(assembly, connectors));
    let coefficient = mechanism.surfaces.together(bodies).rolling;
    if coefficient == 0.0 {
        return None;
    }
    let radius = mechanism.rolling_radius((bodies, features))?;
    let movings = bodies.map(|body| assembly.moving_at(body, assembly.now()));
    let row = TangentRow::of_turning(radius, [&movings[0], &movings[1]]);
    Some((row, coefficient))
}
