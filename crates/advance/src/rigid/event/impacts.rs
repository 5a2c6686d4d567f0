//! The impulses of an event and what is told of them.

use super::region::Region;
use crate::rigid::error::{AdvanceError, Between};
use crate::rigid::limits::bounces::closes_fast;
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Collision, Detector, Moving};
use halfgap_contact::{CollisionRow, Impact, ImpactError, InverseInertia};
use halfgap_geometry::GapSample;

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

/// In what way an impact is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manner {
    /// By the scene's law.
    Lawful,
    /// Without elasticity.
    Inelastic,
    /// The same, unless that takes long.
    Trial,
}

impl RigidSystem {
    /// Rates [m/s] up to which a row counts as neither closing nor opening.
    pub(crate) fn rest_speed(&self) -> f64 {
        self.settings.rest_speed
    }

    pub(crate) fn inertia(&self, body: BodyId) -> InverseInertia {
        if body.is_world() {
            return InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        }
        let body = self.flyer(body).body();
        InverseInertia { inverse_mass: body.inverse_mass, inverse_moment: body.inverse_moment }
    }

    /// Resolves the impact of a region's rows; the bodies, which must be in flight, go on with changed
    /// velocities, and the records are brought up to date. `report` tells of it.
    pub(crate) fn resolve_impact(
        &mut self,
        region: &mut Region,
        impact: &mut Impact,
        report: &mut ImpactReport,
        time: Time,
        manner: Manner,
    ) -> Result<(), AdvanceError> {
        let outcome = self.find_impulses(region, impact, manner);
        outcome.map_err(|source| impact_error(region, time, source))?;
        if self.leave_out_jammed(region, impact) {
            let outcome = self.find_impulses_of_pressed(region, impact, manner);
            outcome.map_err(|source| impact_error(region, time, source))?;
        }
        while self.hold_back(region, impact.rates()) {
            let outcome = self.find_impulses(region, impact, manner);
            outcome.map_err(|source| impact_error(region, time, source))?;
        }
        self.conclude_impact(region, impact, report, time);
        Ok(())
    }

    /// Finds the impulses of a region's rows.
    pub(super) fn find_impulses(
        &self,
        region: &Region,
        impact: &mut Impact,
        manner: Manner,
    ) -> Result<(), ImpactError> {
        self.set_rows(region, impact);
        match manner {
            Manner::Lawful => self.settings.law.resolve(impact, self.settings.order, self.counts.impacts),
            Manner::Inelastic => impact.resolve_inelastic(),
            Manner::Trial => impact.try_inelastic(),
        }
    }

    /// The row of a record, as an impact sees it.
    pub(crate) fn row_of(&self, record: &Collision) -> CollisionRow {
        CollisionRow::of_collision(record, record.bodies().map(|body| self.inertia(body)))
    }

    /// True if what a unilateral record is of was held until now.
    fn was_held(&self, record: &Collision) -> bool {
        match record.parties.detector {
            Detector::Connector { id, .. } => self.is_held_unilaterally(id),
            _ => self.is_likely(record).is_some(),
        }
    }

    /// Gives an impact the rows of a region.
    pub(crate) fn set_rows(&self, region: &Region, impact: &mut Impact) {
        let dull = self.settings.impulse_step.is_none() && self.bounces_low(region);
        let rows = region.records.iter().map(|record| {
            let row = self.row_of(record);
            let elasticity = if dull && closes_fast(record) { 0.0 } else { row.elasticity };
            CollisionRow { elasticity, held: self.was_held(record), ..row }
        });
        impact.set_rows(rows);
    }

    /// Gives the bodies of a region, which must be in flight, the velocities that a resolved impact leaves
    /// them, and reports it.
    pub(crate) fn conclude_impact(
        &mut self,
        region: &mut Region,
        impact: &Impact,
        report: &mut ImpactReport,
        time: Time,
    ) {
        self.counts.contact_solves += impact.solves();
        self.apply_impulses(region, impact, time);
        self.write_report(region, impact, report, time);
    }

    fn apply_impulses(&mut self, region: &mut Region, impact: &Impact, time: Time) {
        region.sum_changes(impact);
        for (&body, &[x, y, spin]) in region.bodies.iter().zip(&region.changes) {
            self.book_damping(body, time);
            self.interrupt(body).cut(time, DVec2::new(x, y), spin);
            if [x, y, spin] != [0.0; 3] {
                self.limits.struck[body.index()] = Some(time);
            }
        }
        for (record, &impulse) in region.records.iter_mut().zip(impact.impulses()) {
            record.response.impulse = Some(impulse);
            // Beyond the end of a feature its gap is of nothing.
            if record.parties.primary.site.is_some() && record.geometry.outside <= 0.0 {
                self.counts.note_gap(record.geometry.distance);
            }
        }
    }

    fn write_report(&self, region: &Region, impact: &Impact, report: &mut ImpactReport, time: Time) {
        report.time = time;
        report.energy_change = 0.0;
        report.rows.clear();
        for (index, record) in region.records.iter().enumerate() {
            let impulse = impact.impulses()[index];
            let (rate_before, rate_after) = (impact.rows()[index].rate, impact.rates()[index]);
            if impulse != 0.0 {
                // What the bodies do: by long arms their rounding moves rows by more than that of the rows' own rates.
                report.energy_change += 0.5 * impulse * (rate_before + self.rate_of(record, time));
                report.rows.push(RowReport { collision: *record, rate_before, rate_after, impulse });
            }
        }
        report.states.clear();
        let struck = region.bodies.iter().zip(&region.struck).filter(|&(_, &is_struck)| is_struck);
        report.states.extend(struck.map(|(&body, _)| (body, self.flyer(body).state_at(time))));
    }

    /// Rate of the gap of a record [m/s] by the bodies' motion at a time, at which they are still where it
    /// was measured.
    fn rate_of(&self, record: &Collision, time: Time) -> f64 {
        let j = &record.motion.kinematics.jacobian;
        let sides = record.bodies();
        let of_side = |(side, body): (usize, BodyId)| {
            let Moving { velocity, angular_velocity, .. } = self.moving_at(body, time);
            j[3 * side] * velocity.x + j[3 * side + 1] * velocity.y + j[3 * side + 2] * angular_velocity
        };
        sides.into_iter().enumerate().map(of_side).sum()
    }

    /// Brings a record to the bodies' present motion at a time.
    pub(crate) fn remeasure_record(&self, record: &mut Collision, time: Time) {
        if let Detector::Connector { id, row } = record.parties.detector {
            return self.remeasure_connector(record, id, row, time);
        }
        let sides = [record.parties.primary, record.parties.normal];
        let (Some(primary), Some(normal)) = (sides[0].feature(), sides[1].feature()) else { return };
        let moving = sides.map(|side| self.moving_at(side.body, time));
        let shape = |side: usize| &self.flyer(sides[side].body).body().shape;
        let (primary, normal) = (shape(0).feature(primary), shape(1).feature(normal));
        let sample = GapSample::measure(primary, &moving[0].pose, normal, &moving[1].pose);
        if let Some(sample) = sample {
            debug_assert!(sample.primary_is_a, "records have their primary first");
            let measured = (&sample, [primary.radius(), normal.radius()]);
            record.update(measured, [&moving[0], &moving[1]], time.seconds());
        }
    }

    /// A body's motion at a time of its present segment; the background rests.
    pub(crate) fn moving_at(&self, body: BodyId, time: Time) -> Moving {
        if body.is_world() { Moving::BACKGROUND } else { self.flyer(body).moving_at(time) }
    }
}

fn impact_error(region: &Region, time: Time, source: ImpactError) -> AdvanceError {
    let mut bodies: Vec<BodyId> = region.records.iter().flat_map(Collision::bodies).collect();
    bodies.sort_unstable();
    bodies.dedup();
    let record = source.row().and_then(|row| region.records.get(row));
    AdvanceError::Impact { time: time.seconds(), bodies, between: record.map(Between::of), source }
}
