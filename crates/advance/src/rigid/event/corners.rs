//! Corners of rails: the point of a rail comes to one, may rest in it, and leaves it along one of its sides.
//!
//! Where a path turns, the point is on the piece before the corner or on the one after it. Let the normals n face into
//! the angle between the two, and u be the point's velocity: then n.u = 0 for its own piece and n.u >= 0 for the other
//! one. Two unilateral rows keep to this, except that they would let the point leave both pieces. So the point of a
//! rail has two unilateral rows from when it comes to a corner until one of them opens, or carries no force; the other
//! goes on as the bilateral row of its piece. Where both would open, the point is kept on one of the sides, whose force
//! or impulse then holds it back. A stop that lies in a corner is at the end of the piece along which the point comes:
//! a point that bounces off it does not turn.

use super::cause::{Cause, EventWork};
use super::events::Booking;
use super::impacts::Manner;
use super::region::Region;
use crate::rigid::error::AdvanceError;
use crate::rigid::step::rows::{RowSource, end_rooms};
use crate::rigid::system::{RigidSettings, RigidSystem};
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, ConnectorId, ConnectorKind, Detector};

/// Number of times that a stop in a corner is met without time going by.
const MOST_AGAIN: u32 = 2;

/// A corner of a rail that holds the rail's point, in a region.
#[derive(Clone, Copy, Debug)]
struct Corner {
    id: ConnectorId,
    /// Indices of the records of its sides, before and after.
    records: [usize; 2],
}

impl RigidSystem {
    /// Notes which points of rails are in a corner at the start. A moving point is put on the side along which it
    /// moves: if that leads through the corner, the point comes to it at once.
    pub(super) fn note_corners(&mut self) {
        let (now, fast) = (self.now, self.settings.tolerances.velocity_tol);
        for index in 0..self.connectors.all.len() {
            let id = ConnectorId(u32::try_from(index).unwrap_or(u32::MAX));
            let ConnectorKind::Rail { path, .. } = &self.connector(id).kind else { continue };
            let within = self.settings.tolerances.accuracy;
            let corner = path.corner_at(self.point_on_rail(id, now), within);
            self.connectors.states[index].corner = corner;
            let [before, after] = [0, 1].map(|side| match corner {
                Some(_) => self.measure_connector(id, side, now).kinematics.rate.abs(),
                None => 0.0,
            });
            if before.max(after) > fast {
                self.go_along(id, usize::from(after < before));
            }
        }
    }

    /// Takes the point of a rail along the next piece of its path; at a corner, its velocity across that is stopped.
    pub(super) fn pass_joint(&mut self, work: &mut EventWork, id: ConnectorId) -> Result<(), AdvanceError> {
        // A point that meets the stop again at once rests there, in the corner, which holds it as well.
        if let Some(stop) = self.stop_in_corner(id)
            && self.connectors.states[stop.index()].repeats_at(self.now) < MOST_AGAIN
        {
            return self.meet_stop(work, stop);
        }
        self.collect_region(&mut work.region, &work.seeds, self.now);
        let is_corner = self.pass_knot(id, self.now) | self.pass_joints_beside(&work.region.bodies, id);
        work.region.cause = if is_corner { Cause::Other } else { Cause::SmoothJoint };
        self.handle_impact(work)
    }

    /// Takes the points of other rails of some bodies along, too, if they come to their joints now: what happens at one
    /// time is one event. True if any comes to a corner. A point with a stop in its corner meets that.
    fn pass_joints_beside(&mut self, bodies: &[BodyId], passed: ConnectorId) -> bool {
        let mut any = false;
        for &body in bodies {
            for index in 0..self.connectors.of(body).len() {
                let id = self.connectors.of(body)[index];
                if id != passed && self.comes_to_joint(id) && self.stop_in_corner(id).is_none() {
                    any |= self.pass_knot(id, self.now);
                }
            }
        }
        any
    }

    /// True if the point of a rail that is in no corner comes to the end of its piece, but for the error of a step.
    fn comes_to_joint(&self, id: ConnectorId) -> bool {
        let ConnectorKind::Rail { a, path } = &self.connector(id).kind else { return false };
        let state = &self.connectors.states[id.index()];
        if state.corner.is_some() {
            return false;
        }
        let moving = self.moving_at(a.body, self.now);
        let arm = moving.pose.vector_to_world(a.point);
        let place = path.nearest(moving.pose.position + arm, state.hint.as_ref());
        let along = moving.velocity_at(arm).dot(place.tangent());
        let ahead = end_rooms(path, &place).into_iter().flatten().find(|end| end.is_forward == (along > 0.0));
        let RigidSettings { steps, tolerances, .. } = &self.settings;
        let error = tolerances.accuracy.min(steps.local_error * steps.length);
        along != 0.0 && ahead.is_some_and(|end| end.room <= error)
    }

    /// Handles a rope that goes taut, or a point that comes to the stop of its rail.
    pub(super) fn meet_stop(&mut self, work: &mut EventWork, id: ConnectorId) -> Result<(), AdvanceError> {
        work.region.cause = Cause::Taut(id);
        if self.connector(id).is_stop() {
            self.connectors.states[id.index()].note_taut(self.now);
        }
        self.handle_impact(work)
    }

    /// Finds the stop that keeps the point of a rail on the piece along which it comes, where that ends in a corner.
    fn stop_in_corner(&self, rail: ConnectorId) -> Option<ConnectorId> {
        let hint = self.connectors.states[rail.index()].hint?;
        let moving = self.connector(rail).bodies().map(|body| self.moving_at(body, self.now));
        let (accuracy, rest) = (self.settings.tolerances.accuracy, self.rest_speed());
        let mut beside = self.connectors.of(self.connector(rail).bodies()[0]).iter().copied();
        beside.find(|&id| {
            let stop = self.connector(id);
            if !stop.is_stop_of(self.connector(rail)) || !self.is_at_end(id, &hint) {
                return false;
            }
            let left = self.hint_at(id, 0, self.now).and_then(|hint| hint.before_stop());
            let sample = stop.measure_near(0, &moving[0], &moving[1], Some(&hint.with_before_stop(left)));
            sample.kinematics.rate <= rest && sample.gap.abs() <= accuracy
        })
    }

    /// Puts a point that an impact drives off both sides of its corner on one of them, whose row then holds it back in
    /// the same impact. True if there is such a point.
    pub(super) fn hold_back(&mut self, region: &mut Region, rates: &[f64]) -> bool {
        let (rest, fast) = (self.rest_speed(), self.settings.tolerances.velocity_tol);
        let opening = |corner: Corner| corner.records.map(|record| rates[record]);
        let is_driven_out = |corner: &Corner| {
            let [before, after] = opening(*corner);
            before.min(after) > rest && before.max(after) > fast
        };
        let Some(corner) = corners(region).find(is_driven_out) else { return false };
        let opening = opening(corner);
        self.take_slower(region, corner, opening);
        true
    }

    /// Puts a point that two forces do not hold in its corner on one of the sides, and stops its velocity across that
    /// side. True if there is such a point: forces are to be found anew.
    pub(super) fn leave_loose_corner(&mut self, work: &mut EventWork) -> Result<bool, AdvanceError> {
        let held = &work.settling.held;
        let sides = |id: ConnectorId| {
            [0, 1].map(|side| held.iter().any(|(_, row)| row.source == RowSource::Connector(id, side)))
        };
        let is_loose =
            |corner: &Corner| sides(corner.id) != [true; 2] && !self.is_left_alone(&work.region, *corner);
        let Some(corner) = corners(&work.region).find(is_loose) else { return Ok(false) };
        if let Some(side) = sides(corner.id).iter().position(|is_held| *is_held) {
            self.take_side(&mut work.region, corner, side);
        } else {
            let rates = corner.rates(&work.region);
            let opens = rates.into_iter().any(|rate| rate > self.rest_speed());
            let opening = if opens { rates } else { self.accelerations_of(work, corner.records) };
            self.take_slower(&mut work.region, corner, opening);
        }
        self.stop_across(work, corner.id)?;
        Ok(true)
    }

    /// True for a side from which the point of a rail parts slowly: the force that presses it into the corner keeps it
    /// there, for rounding of positions produces such speeds again and again.
    pub(crate) fn stays_in_corner(&self, record: &Collision) -> bool {
        let is_slow = record.motion.normal_velocity <= record.tolerances.velocity_tol;
        is_slow && record.connector().is_some_and(|id| self.connectors.states[id.index()].corner.is_some())
    }

    /// True for a point at rest in a corner on whose body nothing acts: it stays there until something does.
    fn is_left_alone(&self, region: &Region, corner: Corner) -> bool {
        let [body, _] = self.connector(corner.id).bodies();
        let record = &region.records[corner.records[0]];
        let kinematics = &record.motion.kinematics;
        let is_still = corner.rates(region) == [0.0; 2] && kinematics.gamma == 0.0;
        let only_rows = region
            .records
            .iter()
            .all(|other| !other.involves_body(body) || other.connector() == Some(corner.id));
        let flyer = self.flyer(body);
        is_still && only_rows && self.laws.of(body).is_empty() && flyer.law().acceleration == DVec2::ZERO
    }

    /// Stops the velocity of a point across the side along which it leaves a corner; that velocity is too slow for an
    /// impact.
    fn stop_across(&mut self, work: &mut EventWork, id: ConnectorId) -> Result<(), AdvanceError> {
        let (now, rest) = (self.now, self.rest_speed());
        let mut records = work.region.records.iter();
        let moves =
            |record: &Collision| record.connector() == Some(id) && record.motion.normal_velocity.abs() > rest;
        if !records.any(moves) {
            return Ok(());
        }
        self.resolve_impact(&mut work.region, &mut work.impact, &mut work.stop, now, Manner::Inelastic)?;
        self.remeasure(&mut work.region, now);
        self.book_impact(&work.stop, Booking::Capture);
        Ok(())
    }

    /// Takes the point of a rail out of its corner along the side from which it parts more slowly, relative to how
    /// easily each row is moved; if both are equal, on along the path. Held there, its row opens the other one: with
    /// free rates f and the matrix A of both rows, the other one opens at f_j - (A_ij/A_ii) f_i, which is positive for
    /// the lesser f_i/sqrt(A_ii).
    fn take_slower(&mut self, region: &mut Region, corner: Corner, opening: [f64; 2]) {
        let [before, after] = [0, 1].map(|side: usize| {
            let row = self.row_of(&region.records[corner.records[side]]);
            let ease: f64 = row.jacobian.iter().zip(&row.response).map(|(j, response)| j * response).sum();
            opening[side] / ease.sqrt()
        });
        self.take_side(region, corner, usize::from(after <= before));
    }

    fn take_side(&mut self, region: &mut Region, corner: Corner, side: usize) {
        self.go_along(corner.id, side);
        let moving = self.connector(corner.id).bodies().map(|body| self.moving_at(body, self.now));
        region.records[corner.records[0]] = self.connector_record(corner.id, 0, &moving, self.now);
        region.records.remove(corner.records[1]);
    }

    /// Takes the point of a rail along a side of the corner in which it is, if it is in one.
    pub(super) fn go_along(&mut self, id: ConnectorId, side: usize) {
        let state = &mut self.connectors.states[id.index()];
        let Some(sides) = state.corner.take() else { return };
        self.set_hint(id, sides[side].facing_left());
    }
}

impl Corner {
    /// Rates [m/s] at which the point parts from the sides.
    fn rates(&self, region: &Region) -> [f64; 2] {
        self.records.map(|record| region.records[record].motion.normal_velocity)
    }
}

/// Corners of rails in a region that hold a point: the records of the two sides follow each other.
fn corners(region: &Region) -> impl Iterator<Item = Corner> + use<'_> {
    let side = |record: &Collision| match record.parties.detector {
        Detector::Connector { id, row } if !record.parties.bilateral => Some((id, row)),
        _ => None,
    };
    region.records.windows(2).enumerate().filter_map(move |(first, pair)| {
        let [(id, 0), (other, 1)] = [side(&pair[0])?, side(&pair[1])?] else { return None };
        (id == other).then_some(Corner { id, records: [first, first + 1] })
    })
}
