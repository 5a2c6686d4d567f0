//! Steps up to the joints of rails that are splines. The third derivative of a spline jumps there, so that a step
//! across loses the order of its method; one that ends there does not. Joints of lines and arcs are events (`watch`).

use crate::rigid::contacts::rows::{ActiveRow, RowSource};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::body_state;
use crate::rigid::settings::StepControl;
use halfgap_collision::{Moving, first_closing_time};

/// Error of a velocity after a step h of the method of order 5, as a multiple of h^2 times the jump of the derivative
/// of its acceleration. It lies between the largest values of two Peano kernels: 0.0019 for what the error estimate
/// shows, and 0.022 for the error itself. Over m joints at equal distances the error is m times as large, not m^2
/// times: between them the curve deviates from a smooth one by as much on either side.
const KERNEL: f64 = 1.0 / 256.0;

impl Dynamics<'_> {
    /// The longest step [s] of points that run on splines: up to the next joint, by the velocity and acceleration at
    /// the start, or longer if joints may be crossed with little error; infinite without splines. The joint need not be
    /// hit exactly: the error falls with the part of the step that lies beyond.
    pub(crate) fn longest_smooth_step(&self, control: &StepControl) -> f64 {
        if !self.group.has_kinks {
            return f64::INFINITY;
        }
        let allowed = control.local_error * self.speed(control);
        let waits = self.group.rows.iter().filter_map(|row| self.wait_for_joint(row, allowed));
        waits.fold(f64::INFINITY, f64::min)
    }

    /// The longest step [s] for one row, where velocities may err by `allowed` [m/s]; `None` if no joint is ahead.
    fn wait_for_joint(&self, row: &ActiveRow, allowed: f64) -> Option<f64> {
        let (RowSource::Connector(id, _), Some(hint)) = (row.source, &row.hint) else { return None };
        let (anchor, path) = self.physics.mechanism.connectors[id.index()].on_rail()?;
        let place = self.group.bodies.binary_search(&anchor.body).ok()?;
        let count = self.group.bodies.len();
        let body = body_state(&self.group.state, count, place);
        let rates = body_state(&self.group.rates, count, place);
        let point = Moving::from(&body).pose.point_to_world(anchor.point);
        let (arm, spin) = (point - body.position, body.angular_velocity);
        let velocity = body.velocity + arm.perp() * spin;
        let acceleration = rates.velocity + arm.perp() * rates.angular_velocity - arm * (spin * spin);
        let joint = path.joint_ahead(hint, velocity)?;
        let way = joint.tangent.dot(joint.point - point);
        if way <= 0.0 {
            return None;
        }
        let wait = first_closing_time(way, -joint.tangent.dot(velocity), -joint.tangent.dot(acceleration))?;
        let speed = velocity.length();
        let over_piece = joint.width / speed;
        let error = KERNEL * joint.jump * speed.powi(3) * over_piece * over_piece;
        Some(if error > allowed { wait } else { over_piece * (allowed / error) })
    }
}

#[cfg(test)]
mod tests {
    use crate::rigid::bodies::trajectory::FreeMotion;
    use crate::rigid::parts::{BodyPart, RigidParts};
    use crate::rigid::settings::{RigidSettings, StepControl};
    use crate::rigid::test_scene::FINE;
    use crate::rigid::test_scene::rooms_of;
    use crate::time::Time;
    use glam::DVec2;
    use halfgap_collision::{Anchor, Body, BodyId, BodyState, Connector, ConnectorKind, RailPath};
    use halfgap_geometry::Shape;
    use std::f64::consts::TAU;
    use std::sync::Arc;

    /// Number of points on a circle of 1 m around the origin.
    const POINTS: u32 = 48;
    /// Start of the disc, in spacings past a point.
    const BEGIN: f64 = 0.3;

    /// Distance, in spacings, covered by the first step of a disc that runs on the curve through the points at a speed
    /// [m/s].
    fn way_of_a_step(local_error: f64, speed: f64) -> f64 {
        let spacing = TAU / f64::from(POINTS);
        let at = |index: f64| DVec2::from_angle(spacing * index);
        let points: Vec<DVec2> = (0..POINTS).map(|index| at(f64::from(index))).collect();
        let path = Arc::new(RailPath::through(&points, true).expect("a curve"));
        let position = path.nearest(at(BEGIN), None).point();
        let shape = Shape::disc(0.1).expect("a fine radius");
        let body = Body { shape, inverse_mass: 1.0, inverse_moment: 1.0, elasticity: 1.0 };
        let velocity = path.nearest(position, None).tangent() * speed;
        let state = BodyState { position, velocity, ..BodyState::default() };
        let rail = ConnectorKind::Rail { a: Anchor { body: BodyId(0), point: DVec2::ZERO }, path };
        let connectors = vec![Connector::new(rail, 0.0).expect("a fine rail")];
        let bodies = vec![BodyPart::new(body, FreeMotion::default(), state)];
        let settings = RigidSettings { steps: StepControl { local_error, ..FINE.steps }, ..FINE };
        let parts = RigidParts { bodies, connectors, ..RigidParts::default() };
        let mut rooms = rooms_of(parts, settings, Time::ZERO);
        let group = rooms.groups.take(BodyId(0)).expect("it is in a group");
        let end = DVec2::new(group.end_state[0], group.end_state[1]);
        position.angle_to(end) / spacing
    }

    #[test]
    fn a_step_ends_at_the_next_joint_of_a_spline() {
        for (speed, way) in [(1.0, 1.0 - BEGIN), (-1.0, -BEGIN)] {
            // At this error the joints count, though the method could step that far.
            let went = way_of_a_step(1e-8, speed);
            // The prediction errs in the third order of the spacing, an eighth of a radian.
            assert!((went - way).abs() < 0.01, "{went} spacings");
        }
    }

    #[test]
    fn joints_that_do_not_matter_are_crossed() {
        // At this error the curve is as good as smooth.
        let went = way_of_a_step(1e-4, 1.0);
        assert!(went > 2.0, "{went} spacings");
    }
}
