//! One impact: the touching rows of a connected group, their impulses, and what becomes of the bodies.

use super::error::{AdvanceError, Between};
use super::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Collision, Moment, Moving, Zone, detect_pair};
use halfgap_contact::{CollisionRow, Impact, Inertia};

/// Rates and accelerations below this many machine epsilons of what they were computed from are zero.
const ROUNDINGS: f64 = 64.0;

/// One row of an impact, as told to the outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowReport {
    /// The record, with its impulse.
    pub collision: Collision,
    /// Rate of the gap before [m/s].
    pub rate_before: f64,
    /// Rate of the gap after [m/s].
    pub rate_after: f64,
    /// Impulse along the normal [N s].
    pub impulse: f64,
}

/// An impact, as told to the outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpactReport {
    /// When.
    pub time: Time,
    /// The rows that carried an impulse.
    pub rows: Vec<RowReport>,
    /// Change of the kinetic energy [J]: the sum of j (v- + v+)/2.
    pub energy_change: f64,
    /// States of the movable bodies that took part, after the impact.
    pub states: Vec<(BodyId, BodyState)>,
}

/// Buffers of the handling of an impact, kept from one to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct ImpactWork {
    records: Vec<Collision>,
    group: Vec<BodyId>,
    impact: Impact,
}

impl ImpactWork {
    /// The movable bodies that take part.
    pub(crate) fn group(&self) -> &[BodyId] {
        &self.group
    }
}

impl RigidSystem {
    /// Collects the touching rows of the group around two bodies and resolves their impact at a time.
    ///
    /// The bodies' segments are cut at that time; predictions are left to the caller. False if no row needed an impulse;
    /// else `report` tells of it.
    pub(crate) fn resolve_impact(
        &mut self,
        work: &mut ImpactWork,
        report: &mut ImpactReport,
        bodies: [BodyId; 2],
        time: Time,
    ) -> Result<bool, AdvanceError> {
        self.collect_group(work, bodies, time);
        let inertia = |body: BodyId| {
            let body = self.flyer(body).body();
            Inertia { inverse_mass: body.inverse_mass, inverse_moment: body.inverse_moment }
        };
        let rows = work.records.iter().map(|record| {
            let sides = [record.parties.primary.body, record.parties.normal.body];
            CollisionRow::of_collision(record, sides.map(inertia))
        });
        work.impact.set_rows(rows);
        let random = self.counts.impacts;
        self.settings.law.resolve(&mut work.impact, self.settings.order, random).map_err(|source| {
            let mut named: Vec<u32> = work
                .records
                .iter()
                .flat_map(|record| [record.parties.primary.body.0, record.parties.normal.body.0])
                .collect();
            named.sort_unstable();
            named.dedup();
            AdvanceError::Impact { time: time.seconds(), bodies: named, source }
        })?;
        self.counts.contact_solves += work.impact.solves();
        self.apply_impulses(work, time);
        self.write_report(work, report, time);
        self.refuse_resting(work, time)?;
        Ok(!report.rows.is_empty())
    }

    /// The bodies that touch each other around two given ones, and their records in the target zone or nearer.
    fn collect_group(&mut self, work: &mut ImpactWork, bodies: [BodyId; 2], time: Time) {
        work.records.clear();
        work.group.clear();
        work.group.extend(bodies.into_iter().filter(|&body| !self.flyer(body).body().is_fixed()));
        let mut next = 0;
        while next < work.group.len() {
            let body = work.group[next];
            let moving = self.flyer(body).moving_at(time);
            for &pair in self.pairs.of_body(body) {
                let [a, b] = self.pairs.get(pair).bodies;
                let other = if a == body { b } else { a };
                // A pair within the group was collected with its first body.
                if work.group[..next].contains(&other) {
                    continue;
                }
                let touches = self.detect((body, &moving), other, time, &mut work.records);
                if touches && !self.flyer(other).body().is_fixed() && !work.group.contains(&other) {
                    work.group.push(other);
                }
            }
            next += 1;
        }
    }

    /// Adds the records of two bodies in the target zone or nearer; true if there are any.
    fn detect(
        &self,
        (body, moving): (BodyId, &Moving),
        other: BodyId,
        time: Time,
        records: &mut Vec<Collision>,
    ) -> bool {
        let tolerances = &self.settings.tolerances;
        let (flyer, other_flyer) = (self.flyer(body), self.flyer(other));
        let reach = flyer.reach() + other_flyer.reach() + tolerances.distance_tol();
        let other_moving = other_flyer.moving_at(time);
        if (moving.pose.position - other_moving.pose.position).length_squared() > reach * reach {
            return false;
        }
        // The lesser body first: records do not depend on which of the two was found first.
        let moments = [
            Moment { id: body, body: flyer.body(), moving: *moving },
            Moment { id: other, body: other_flyer.body(), moving: other_moving },
        ];
        let [first, second] = if body < other { [0, 1] } else { [1, 0] };
        let before = records.len();
        detect_pair(
            &moments[first],
            &moments[second],
            tolerances,
            tolerances.distance_tol(),
            time.seconds(),
            records,
        );
        let mut index = before;
        while index < records.len() {
            // Farther than the target zone a row fires in its own time.
            if records[index].zone() < Zone::Target { _ = records.remove(index) } else { index += 1 }
        }
        records.len() > before
    }

    fn apply_impulses(&mut self, work: &mut ImpactWork, time: Time) {
        for &body in &work.group {
            let (mut velocity, mut spin) = (DVec2::ZERO, 0.0);
            for (row, &impulse) in work.impact.rows().iter().zip(work.impact.impulses()) {
                for (side, _) in
                    row.bodies.iter().enumerate().filter(|&(_, &taking_part)| taking_part == body)
                {
                    let change = &row.response[3 * side..];
                    velocity += DVec2::new(change[0], change[1]) * impulse;
                    spin += change[2] * impulse;
                }
            }
            self.flyer_mut(body).cut(time, velocity, spin);
        }
        for (record, &impulse) in work.records.iter_mut().zip(work.impact.impulses()) {
            record.response.impulse = Some(impulse);
            self.counts.note_gap(record.geometry.distance);
        }
    }

    fn write_report(&self, work: &ImpactWork, report: &mut ImpactReport, time: Time) {
        report.time = time;
        report.energy_change = 0.0;
        report.rows.clear();
        for (index, record) in work.records.iter().enumerate() {
            let impulse = work.impact.impulses()[index];
            let (rate_before, rate_after) = (work.impact.rows()[index].rate, work.impact.rates()[index]);
            if impulse != 0.0 {
                report.energy_change += 0.5 * impulse * (rate_before + rate_after);
                report.rows.push(RowReport { collision: *record, rate_before, rate_after, impulse });
            }
        }
        report.states.clear();
        let takes_part = |body: BodyId| report.rows.iter().any(|row| row.collision.involves_body(body));
        let states = work.group.iter().filter(|&&body| takes_part(body));
        report.states.extend(states.map(|&body| (body, self.flyer(body).state_at(time))));
    }

    /// A row that neither opens nor accelerates away would need a contact force.
    fn refuse_resting(&self, work: &ImpactWork, time: Time) -> Result<(), AdvanceError> {
        for (record, &rate) in work.records.iter().zip(work.impact.rates()) {
            let sides = [record.parties.primary.body, record.parties.normal.body];
            let [a, b] = sides.map(|body| self.flyer(body));
            let moving = [a.moving_at(time), b.moving_at(time)];
            let arms = [record.geometry.arms.primary.length(), record.geometry.arms.normal.length()];
            let speed = |side: usize| {
                moving[side].velocity.length() + moving[side].angular_velocity.abs() * arms[side]
            };
            let still =
                ROUNDINGS * f64::EPSILON * (speed(0) + speed(1) + record.motion.normal_velocity.abs());
            if rate > still {
                continue;
            }
            let spins = [a.accelerations_at(time), b.accelerations_at(time)];
            let mut after = *record;
            self.remeasure(&mut after, &moving, time);
            let acceleration = after.motion.kinematics.acceleration(&spins[0], &spins[1]);
            let push = |side: usize| {
                let spin = moving[side].angular_velocity;
                spins[side].linear.length() + (spins[side].angular.abs() + spin * spin) * arms[side]
            };
            if acceleration < -ROUNDINGS * f64::EPSILON * (push(0) + push(1)) {
                let between = Between { primary: sides[0], normal: sides[1] };
                return Err(AdvanceError::RestingContact { time: time.seconds(), between });
            }
        }
        Ok(())
    }

    /// Brings a record to the bodies' velocities after the impulses.
    fn remeasure(&self, record: &mut Collision, moving: &[halfgap_collision::Moving; 2], time: Time) {
        let sides = [&record.parties.primary, &record.parties.normal]
            .map(|side| side.feature().map(|feature| self.flyer(side.body).body().shape.feature(feature)));
        // The rows of connectors have no features.
        let [Some(primary), Some(normal)] = sides else { return };
        let sample = halfgap_geometry::GapSample::measure(primary, &moving[0].pose, normal, &moving[1].pose);
        if let Some(sample) = sample.filter(|sample| sample.primary_is_a) {
            record.update(
                (&sample, [primary.radius(), normal.radius()]),
                [&moving[0], &moving[1]],
                time.seconds(),
            );
        }
    }
}
