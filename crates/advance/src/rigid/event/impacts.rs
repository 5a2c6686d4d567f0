//! The impulses of an event, and their report.

use super::region::Region;
use crate::rigid::error::{AdvanceError, Between};
use crate::rigid::held::squeezed::LARGEST_MASS_RATIO;
use crate::rigid::limits::bounces::closes_fast;
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Collision, Detector, Moving};
use halfgap_contact::{CollisionRow, Impact, ImpactError, InverseInertia};
use halfgap_geometry::GapSample;

/// Report of one row of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowReport {
    /// Collision record of the row, with its impulse.
    pub collision: Collision,
    /// Rate of the gap before the impact [m/s]; negative closes.
    pub rate_before: f64,
    /// Rate of the gap after the impact [m/s]; negative closes.
    pub rate_after: f64,
    /// Impulse on the primary body along the normal [N s]: positive pushes the bodies apart.
    pub impulse: f64,
}

/// Report of an impact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpactReport {
    /// Time of the impact.
    pub time: Time,
    /// The rows that carried an impulse.
    pub rows: Vec<RowReport>,
    /// Change of the kinetic energy [J]: the sum of j (v- + v+)/2 over the rows.
    pub energy_change: f64,
    /// States after the impact of the movable bodies on which an impulse acted.
    pub states: Vec<(BodyId, BodyState)>,
}

/// Manner in which an impact is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manner {
    /// By the impact law of the settings.
    Lawful,
    /// Without elasticity.
    Inelastic,
    /// Without elasticity, but given up if that takes long.
    Trial,
}

impl RigidSystem {
    /// Largest rate [m/s] at which a row counts as neither closing nor opening.
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

    /// Resolves the impact of a region's rows and writes the report. The bodies, which must be in flight, go on with
    /// changed velocities, and the records get their impulses.
    pub(crate) fn resolve_impact(
        &mut self,
        region: &mut Region,
        impact: &mut Impact,
        report: &mut ImpactReport,
        time: Time,
        manner: Manner,
    ) -> Result<(), AdvanceError> {
        let outcome = self.find_impulses(region, impact, manner);
        outcome.map_err(|source| self.impact_error(region, time, source))?;
        if self.leave_out_jammed(region, impact) {
            let outcome = self.find_impulses_of_pressed(region, impact, manner);
            outcome.map_err(|source| self.impact_error(region, time, source))?;
        }
        while self.hold_back(region, impact.rates()) {
            let outcome = self.find_impulses(region, impact, manner);
            outcome.map_err(|source| self.impact_error(region, time, source))?;
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

    /// Row of a record in an impact.
    pub(crate) fn row_of(&self, record: &Collision) -> CollisionRow {
        CollisionRow::of_collision(record, record.bodies().map(|body| self.inertia(body)))
    }

    /// True if the contact or unilateral connector of a record was held until now.
    fn was_held(&self, record: &Collision) -> bool {
        match record.parties.detector {
            Detector::Connector { id, .. } => self.is_held_unilaterally(id),
            _ => self.is_likely(record).is_some(),
        }
    }

    /// Sets the rows of an impact to those of a region.
    pub(crate) fn set_rows(&self, region: &Region, impact: &mut Impact) {
        let dull = self.settings.impulse_step.is_none() && self.bounces_low(region);
        let rows = region.records.iter().map(|record| {
            let row = self.row_of(record);
            let elasticity = if dull && closes_fast(record) { 0.0 } else { row.elasticity };
            CollisionRow { elasticity, held: self.was_held(record), ..row }
        });
        impact.set_rows(rows);
    }

    /// Gives the bodies of a region, which must be in flight, their velocities after a resolved impact, and writes the
    /// report.
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
            // Beyond the end of a feature its gap is no distance between bodies.
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
                // The rate afterwards is that of the bodies: by long arms the rounding of their velocities moves rows
                // by more than the rounding of the rows' own rates.
                report.energy_change += 0.5 * impulse * (rate_before + self.rate_of(record, time));
                report.rows.push(RowReport { collision: *record, rate_before, rate_after, impulse });
            }
        }
        report.states.clear();
        let struck = region.bodies.iter().zip(&region.struck).filter(|&(_, &is_struck)| is_struck);
        report.states.extend(struck.map(|(&body, _)| (body, self.flyer(body).state_at(time))));
    }

    /// Rate of the gap of a record [m/s] by the bodies' motion at a time; the bodies must still be where it was
    /// measured.
    fn rate_of(&self, record: &Collision, time: Time) -> f64 {
        let j = &record.motion.kinematics.jacobian;
        let sides = record.bodies();
        let of_side = |(side, body): (usize, BodyId)| {
            let Moving { velocity, angular_velocity, .. } = self.moving_at(body, time);
            j[3 * side] * velocity.x + j[3 * side + 1] * velocity.y + j[3 * side + 2] * angular_velocity
        };
        sides.into_iter().enumerate().map(of_side).sum()
    }

    /// Updates a record to the bodies' present motion at a time.
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

    /// Motion of a body at a time of its present segment; the background rests.
    pub(crate) fn moving_at(&self, body: BodyId, time: Time) -> Moving {
        if body.is_world() { Moving::BACKGROUND } else { self.flyer(body).moving_at(time) }
    }

    fn impact_error(&self, region: &Region, time: Time, source: ImpactError) -> AdvanceError {
        let touching = region.records.iter().map(Collision::bodies);
        if let Err(squeezed) = self.refuse_squeezed(touching, LARGEST_MASS_RATIO, time) {
            return squeezed;
        }
        let mut bodies: Vec<BodyId> = region.records.iter().flat_map(Collision::bodies).collect();
        bodies.sort_unstable();
        bodies.dedup();
        let record = source.row().and_then(|row| region.records.get(row));
        AdvanceError::Impact { time: time.seconds(), bodies, between: record.map(Between::of), source }
    }
}
