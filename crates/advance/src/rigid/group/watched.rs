//! Longest steps of bodies in contact. Along a step the forces of contacts, which no error estimate shows where nothing
//! accelerates, and the gaps of contacts without force must be sampled well.

use crate::rigid::contacts::rows::{ActiveRow, RowSource, moving_of};
use crate::rigid::group::attempt::STEADY_GROWTH;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::body_state;
use crate::rigid::shares::WAY_OF_A_STEP;
use glam::DVec2;
use halfgap_collision::{GapKinematics, Moving, first_closing_time};
use halfgap_geometry::GapKind;

impl Dynamics<'_> {
    /// The longest step [s] along which contacts are surely sampled well. Where forces have not varied along the last
    /// step, as on a body that slides or is carried along, it may be longer.
    pub(crate) fn longest_watched_step(&self) -> f64 {
        let group = &*self.group;
        let any_idle = !group.idle.is_empty();
        if !any_idle && group.rows.iter().all(|row| row.bilateral) {
            return f64::INFINITY;
        }
        let steady = group.steady_step.map_or(0.0, |step| STEADY_GROWTH * step);
        let by_way = steady.max(self.longest_step_by_way(!any_idle));
        // Measuring each contact takes longer: that is done only if the first bound is too short, and nothing else moves.
        let is_enough =
            any_idle || !group.moved.is_empty() || group.next_step.is_some_and(|step| step <= by_way);
        if is_enough { by_way } else { by_way.max(self.longest_step_by_rows()) }
    }

    /// The step [s] along which no point of a body moves by more than the fraction of its reach. Discs may be left out:
    /// their contacts do not vary as they turn.
    fn longest_step_by_way(&self, spares_discs: bool) -> f64 {
        let group = &*self.group;
        let count = group.bodies.len();
        let waits = group.bodies.iter().enumerate().map(|(place, &body)| {
            let trajectory = &self.physics.mechanism.trajectories[body.index()];
            if spares_discs && trajectory.disc().is_some() {
                return f64::INFINITY;
            }
            let of_points = |values: &[f64]| {
                let at = 3 * (count + place);
                trajectory.fastest_point([values[at], values[at + 1], values[at + 2]])
            };
            wait(WAY_OF_A_STEP * trajectory.reach(), of_points(&group.state), of_points(&group.rates))
        });
        waits.chain(self.waits_for_moved()).fold(f64::INFINITY, f64::min)
    }

    /// The steps [s] along which no point of a moved body moves by more than the fraction of its reach.
    fn waits_for_moved(&self) -> impl Iterator<Item = f64> {
        self.group.moved.iter().map(|body| {
            let trajectory = &self.physics.mechanism.trajectories[body.index()];
            let moving = trajectory.moving_at(self.start);
            let acceleration = trajectory.prescribed_acceleration(self.start);
            let of_points =
                |linear: DVec2, turning: f64| trajectory.fastest_point([linear.x, linear.y, turning]);
            wait(
                WAY_OF_A_STEP * trajectory.reach(),
                of_points(moving.velocity, moving.angular_velocity),
                of_points(acceleration.linear, acceleration.angular),
            )
        })
    }

    /// The step [s] along which no active contact changes by more than the fraction: its normal and its bodies turn, and
    /// it runs along the side of a moving body. A body that moves straight along a floor does none of that, however
    /// far, nor do bodies that move together. For contacts without force this is no bound: their gaps vary, too.
    fn longest_step_by_rows(&self) -> f64 {
        let contacts = self.group.rows.iter().filter(|row| !row.bilateral);
        contacts.map(|row| self.wait_for_row(row)).fold(f64::INFINITY, f64::min)
    }

    /// The longest step [s] for one row; infinite for a row of a connector.
    fn wait_for_row(&self, row: &ActiveRow) -> f64 {
        let RowSource::Contact(features) = row.source else { return f64::INFINITY };
        let group = &*self.group;
        let places = row.bodies.map(|body| group.bodies.binary_search(&body).ok());
        let of = |place: usize, values: &[f64]| body_state(values, group.bodies.len(), place);
        let movings = [0, 1].map(|side: usize| match places[side] {
            Some(place) => Moving::from(&of(place, &group.state)),
            None => *moving_of(&self.stage.movings, row.bodies[side]),
        });
        let sample = self.physics.mechanism.sample(row.bodies, features, [&movings[0], &movings[1]]);
        let kinematics = GapKinematics::of(&sample, &movings[0], &movings[1]);
        // Sums over the movable bodies: rates [rad/s] and accelerations [rad/s^2] of turning; their largest reach [m].
        let (mut turn, mut turn_rate, mut reach) = (kinematics.normal_rate.length(), 0.0, 0.0f64);
        let mut pull = DVec2::ZERO;
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            let Some(place) = places[side] else { continue };
            let rates = of(place, &group.rates);
            let trajectory = &self.physics.mechanism.trajectories[row.bodies[side].index()];
            reach = reach.max(trajectory.reach());
            pull += rates.velocity * sign;
            // The turning of a disc changes no contact.
            if trajectory.disc().is_none() {
                turn += movings[side].angular_velocity.abs();
                turn_rate += rates.angular_velocity.abs();
            }
        }
        let along_side = match sample.kind {
            // The contact runs along a side of a body; if that body cannot move, it does not matter.
            GapKind::CenterLine if places[1].is_none() => return wait(WAY_OF_A_STEP, turn, turn_rate),
            GapKind::CenterLine => sample.normal.perp().dot(kinematics.center_velocity).abs() / reach,
            GapKind::CenterCenter => 0.0,
        };
        let arm = match sample.kind {
            GapKind::CenterLine => reach,
            GapKind::CenterCenter => (sample.center_primary - sample.center_normal).length(),
        };
        wait(WAY_OF_A_STEP, turn + along_side, turn_rate + pull.length() / arm)
    }
}

/// Time [s] in which a distance or an angle is covered at a speed and an acceleration; infinite without either.
pub(crate) fn wait(way: f64, speed: f64, acceleration: f64) -> f64 {
    first_closing_time(way, -speed, -acceleration).unwrap_or(f64::INFINITY)
}
