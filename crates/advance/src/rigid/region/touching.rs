//! The region of an event: the bodies that touch each other around some seeds, with the groups that they belong to, and
//! the records of all places where they touch.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::region::cause::Cause;
use halfgap_collision::{BodyId, Collision, GapState};
use halfgap_contact::{Impact, InverseInertia, Problem, ProblemBody, Row};

/// Bodies and records of an event. Buffers are kept from one event to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Region {
    /// The movable bodies, in the order in which they were found.
    pub(super) bodies: Vec<BodyId>,
    /// Records of all places where they touch, each once.
    pub(super) records: Vec<Collision>,
    /// All pairs of features that touch.
    pub(super) touches: Vec<Touch>,
    /// Gap of each pair in `touches` after the event.
    pub(super) motions: Vec<GapState>,
    /// Leaders of the groups of these bodies.
    pub(super) groups: Vec<BodyId>,
    /// Leaders of the steps that these bodies are in.
    pub(super) steps: Vec<BodyId>,
    /// Cause of the event.
    pub(super) cause: Cause,
    /// True if the event is one too many in a short time.
    pub(super) is_accumulating: bool,
    /// True if steps have become so short that contacts that count as resting seem to take turns.
    pub(super) is_hasty: bool,
    /// True if the forces of contacts that stick have come to a bound, and may be shared otherwise.
    pub(super) is_strained: bool,
    pub(super) fresh: Vec<Collision>,
    /// Change of the velocities (x, y, angle) of each body by an impact [m/s, m/s, rad/s].
    pub(super) changes: Vec<[f64; 3]>,
    /// Whether an impulse acts on each body.
    pub(super) struck: Vec<bool>,
    /// Records that are excluded because they jam.
    pub(super) excluded: Vec<Collision>,
    /// Stamp and place in `bodies` of each body, valid where the stamp is the present one.
    pub(super) places: Vec<(u32, u32)>,
    pub(super) stamp: u32,
}

impl Region {
    pub(crate) fn clear(&mut self, body_count: usize) {
        self.bodies.clear();
        self.records.clear();
        self.touches.clear();
        self.motions.clear();
        self.groups.clear();
        self.steps.clear();
        self.places.resize(body_count, (0, 0));
        self.stamp = self.stamp.wrapping_add(1);
        if self.stamp == 0 {
            self.places.fill((0, 0));
            self.stamp = 1;
        }
    }

    /// Sets the cause of the event.
    pub(crate) fn set_cause(&mut self, cause: Cause) {
        self.cause = cause;
    }

    /// Notes whether contacts that count as resting seem to take turns.
    pub(crate) fn set_hasty(&mut self, is_hasty: bool) {
        self.is_hasty = is_hasty;
    }

    /// Notes whether the forces of contacts that stick have come to a bound, and may be shared otherwise.
    pub(crate) fn set_strained(&mut self, is_strained: bool) {
        self.is_strained = is_strained;
    }

    /// True if the forces of contacts that stick have come to a bound, and may be shared otherwise.
    #[inline]
    pub(crate) fn is_strained(&self) -> bool {
        self.is_strained
    }

    /// Admits all excluded records again.
    pub(crate) fn admit_all(&mut self) {
        self.records.append(&mut self.excluded);
    }

    /// Excludes the records of which a test is true; those that were excluded before are forgotten.
    pub(crate) fn exclude(&mut self, is_out: impl Fn(&Collision) -> bool) {
        self.excluded.clear();
        self.excluded.extend(self.records.extract_if(.., |record| is_out(record)));
    }

    /// Admits again the excluded records of which a test is true, given the change of their rate [m/s] by the changes
    /// of the bodies' velocities; true if there are any.
    pub(crate) fn admit(&mut self, is_in: impl Fn(&Collision, f64) -> bool) -> bool {
        let (mut records, mut excluded) =
            (std::mem::take(&mut self.records), std::mem::take(&mut self.excluded));
        let before = records.len();
        records.extend(excluded.extract_if(.., |record| is_in(record, self.change_of(record))));
        let any = records.len() > before;
        (self.records, self.excluded) = (records, excluded);
        any
    }

    /// Change of the rate of a record [m/s] by the changes of its bodies' velocities; positive opens.
    fn change_of(&self, record: &Collision) -> f64 {
        let j = &record.motion.kinematics.jacobian;
        let sides = record.bodies();
        let of_side = |(side, body): (usize, BodyId)| {
            let change = self.place(body).map_or([0.0; 3], |place| self.changes[place]);
            (0..3).map(|k| j[3 * side + k] * change[k]).sum::<f64>()
        };
        let of_two: f64 = sides.into_iter().enumerate().map(of_side).sum();
        match record.parties.third.and_then(|(body, j)| Some((self.place(body)?, j))) {
            Some((place, j)) => of_two + j * self.changes[place][2],
            None => of_two,
        }
    }

    /// Records that are excluded because they jam.
    #[inline]
    pub(crate) fn excluded(&self) -> &[Collision] {
        &self.excluded
    }

    /// Notes whether the event is one too many in a short time.
    pub(crate) fn set_accumulating(&mut self, is_accumulating: bool) {
        self.is_accumulating = is_accumulating;
    }

    /// Keeps the records of which a test is true.
    pub(crate) fn retain_records(&mut self, stays: impl FnMut(&Collision) -> bool) {
        self.records.retain(stays);
    }

    /// Sets the force [N] of a record.
    pub(crate) fn set_force(&mut self, record: usize, force: f64) {
        self.records[record].response.force = Some(force);
    }

    /// Sets the impulses [N s] of all records.
    pub(crate) fn set_impulses(&mut self, impulses: &[f64]) {
        for (record, &impulse) in self.records.iter_mut().zip(impulses) {
            record.response.impulse = Some(impulse);
        }
    }

    /// Replaces a record.
    pub(crate) fn set_record(&mut self, index: usize, record: Collision) {
        self.records[index] = record;
    }

    /// Removes a record.
    pub(crate) fn remove_record(&mut self, index: usize) {
        self.records.remove(index);
    }

    /// The records, for tests that change them.
    #[cfg(test)]
    pub(crate) fn records_mut(&mut self) -> &mut [Collision] {
        &mut self.records
    }

    /// Place of a body in the region; `None` for bodies outside it and those that cannot move.
    pub(crate) fn place(&self, body: BodyId) -> Option<usize> {
        let &(stamp, place) = self.places.get(body.index())?;
        (stamp == self.stamp).then_some(place as usize)
    }

    /// Sums the changes of the bodies' velocities by an impact, and notes which bodies an impulse acts on.
    pub(crate) fn sum_changes(&mut self, impact: &Impact) {
        let (mut changes, mut struck) = (std::mem::take(&mut self.changes), std::mem::take(&mut self.struck));
        changes.clear();
        changes.resize(self.bodies.len(), [0.0; 3]);
        struck.clear();
        struck.resize(self.bodies.len(), false);
        for (row, &impulse) in impact.rows().iter().zip(impact.impulses()) {
            for (side, place) in row.bodies.iter().map(|&body| self.place(body)).enumerate() {
                let Some(place) = place else { continue };
                struck[place] |= impulse != 0.0;
                for (change, response) in changes[place].iter_mut().zip(&row.response[3 * side..]) {
                    *change += response * impulse;
                }
            }
            if let Some(third) = row.third
                && let Some(place) = self.place(third.body)
            {
                struck[place] |= impulse != 0.0;
                changes[place][2] += third.response * impulse;
            }
        }
        for (row, slip) in impact.rows().iter().zip(impact.friction()) {
            let Some((friction, impulse)) = slip else { continue };
            for (side, place) in row.bodies.iter().map(|&body| self.place(body)).enumerate() {
                let Some(place) = place else { continue };
                for (change, response) in changes[place].iter_mut().zip(&friction.response[3 * side..]) {
                    *change += response * impulse;
                }
            }
        }
        (self.changes, self.struck) = (changes, struck);
    }

    /// Row of a record in a problem of the region's bodies, in their order; `None` if none of its bodies moves.
    pub(crate) fn row_of(&self, record: &Collision, offset: f64) -> Option<Row> {
        let row = self.row_along(record, &record.motion.kinematics.jacobian, offset);
        let third = record.parties.third.and_then(|(body, j)| Some((self.problem_body(body)?, j)));
        let row = match third {
            Some((body, j)) => Row::turning(row, body, j, offset),
            None => row?,
        };
        Some(if record.parties.bilateral { row.bilateral() } else { row })
    }

    /// A unilateral row between the bodies of a record, with other coefficients; `None` if neither of its bodies moves.
    pub(crate) fn row_along(&self, record: &Collision, coefficients: &[f64; 6], offset: f64) -> Option<Row> {
        self.row_between(record.bodies(), coefficients, offset)
    }

    /// A unilateral row between two bodies; `None` if neither of them moves.
    pub(crate) fn row_between(
        &self,
        bodies: [BodyId; 2],
        coefficients: &[f64; 6],
        offset: f64,
    ) -> Option<Row> {
        Row::between(bodies.map(|body| self.problem_body(body)), coefficients, offset)
    }

    fn problem_body(&self, body: BodyId) -> Option<ProblemBody> {
        u32::try_from(self.place(body)?).ok().map(ProblemBody)
    }

    /// The row of a record with a force whose direction differs from the normal by a turn.
    pub(crate) fn turned(&self, row: Row, record: &Collision, turn: &[f64; 6]) -> Row {
        let direction = std::array::from_fn(|k| record.motion.kinematics.jacobian[k] + turn[k]);
        let Some(along) = self.row_along(record, &direction, 0.0) else { return row };
        row.with_force(along.primary.1, along.normal.map_or([0.0; 3], |(_, coefficients)| coefficients))
    }

    /// Fills a problem with the region's bodies, without rows.
    pub(crate) fn begin(&self, problem: &mut Problem, inertia: impl Fn(BodyId) -> InverseInertia) {
        problem.clear();
        for &body in &self.bodies {
            problem.add_body(inertia(body)).expect("inertias were checked when the body was made");
        }
    }

    pub(crate) fn add(&mut self, body: BodyId) {
        if self.place(body).is_none() {
            let place = u32::try_from(self.bodies.len()).unwrap_or(u32::MAX);
            self.places[body.index()] = (self.stamp, place);
            self.bodies.push(body);
        }
    }
}

/// Measures gaps and rates of the touching features of a region at the present time.
pub(crate) fn measure_touches(assembly: &Assembly, region: &mut Region) {
    let Region { touches, motions, .. } = region;
    motions.clear();
    motions.extend(touches.iter().map(|&touch| gap_at(assembly, touch, assembly.now())));
}

impl Region {
    /// The movable bodies, in the order in which they were found.
    #[inline]
    pub(crate) fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    /// Cause of the event.
    #[inline]
    pub(crate) fn cause(&self) -> Cause {
        self.cause
    }

    /// Change of the velocities (x, y, angle) of each body by an impact [m/s, m/s, rad/s].
    #[inline]
    pub(crate) fn changes(&self) -> &[[f64; 3]] {
        &self.changes
    }

    /// Leaders of the groups of these bodies.
    #[inline]
    pub(crate) fn groups(&self) -> &[BodyId] {
        &self.groups
    }

    /// Leaders of the steps that these bodies are in.
    #[inline]
    pub(crate) fn steps(&self) -> &[BodyId] {
        &self.steps
    }

    /// True if any of its bodies is in a group or in a step: it moves along another's path.
    #[inline]
    pub(crate) fn is_led(&self) -> bool {
        !(self.groups.is_empty() && self.steps.is_empty())
    }

    /// True if the event is one too many in a short time.
    #[inline]
    pub(crate) fn is_accumulating(&self) -> bool {
        self.is_accumulating
    }

    /// True if steps have become so short that contacts that count as resting seem to take turns.
    #[inline]
    pub(crate) fn is_hasty(&self) -> bool {
        self.is_hasty
    }

    /// Gap of each pair in `touches` after the event.
    #[inline]
    pub(crate) fn motions(&self) -> &[GapState] {
        &self.motions
    }

    /// Records of all places where they touch, each once.
    #[inline]
    pub(crate) fn records(&self) -> &[Collision] {
        &self.records
    }

    /// Whether an impulse acts on each body.
    #[inline]
    pub(crate) fn struck(&self) -> &[bool] {
        &self.struck
    }

    /// All pairs of features that touch.
    #[inline]
    pub(crate) fn touches(&self) -> &[Touch] {
        &self.touches
    }
}
