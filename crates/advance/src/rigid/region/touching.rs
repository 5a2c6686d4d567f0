//! The region of an event: the bodies that touch each other around some seeds, with the groups that they belong to, and
//! the records of all places where they touch.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::region::cause::Cause;
use halfgap_collision::{BodyId, Collision};
use halfgap_contact::{Impact, InverseInertia, Problem, ProblemBody, Row};

/// Bodies and records of an event. Buffers are kept from one event to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Region {
    /// The movable bodies, in the order in which they were found.
    pub(crate) bodies: Vec<BodyId>,
    /// Records of all places where they touch, each once.
    pub(crate) records: Vec<Collision>,
    /// All pairs of features that touch.
    pub(crate) touches: Vec<Touch>,
    /// Gap [m] and rate [m/s] of each pair in `touches` after the event.
    pub(crate) motions: Vec<(f64, f64)>,
    /// Leaders of the groups of these bodies.
    pub(crate) groups: Vec<BodyId>,
    /// Cause of the event.
    pub(crate) cause: Cause,
    /// True if the event is one too many in a short time.
    pub(crate) in_storm: bool,
    /// True if steps have become so short that contacts that count as resting seem to take turns.
    pub(crate) is_hasty: bool,
    /// True if the rows that would be held were found to be unsound: contacts that nearly depend on others are spared,
    /// and all are held where they are.
    pub(crate) is_unsound: bool,
    pub(crate) fresh: Vec<Collision>,
    /// Change of the velocities (x, y, angle) of each body by an impact [m/s, m/s, rad/s].
    pub(crate) changes: Vec<[f64; 3]>,
    /// Whether an impulse acts on each body.
    pub(crate) struck: Vec<bool>,
    /// Records that were left out because they jam.
    pub(crate) left_out: Vec<Collision>,
    /// Stamp and place in `bodies` of each body, valid where the stamp is the present one.
    places: Vec<(u32, u32)>,
    stamp: u32,
}

impl Region {
    pub(crate) fn clear(&mut self, body_count: usize) {
        self.bodies.clear();
        self.records.clear();
        self.touches.clear();
        self.motions.clear();
        self.groups.clear();
        self.is_unsound = false;
        self.places.resize(body_count, (0, 0));
        self.stamp = self.stamp.wrapping_add(1);
        if self.stamp == 0 {
            self.places.fill((0, 0));
            self.stamp = 1;
        }
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
        }
        (self.changes, self.struck) = (changes, struck);
    }

    /// Row of a record in a problem of the region's bodies, in their order; `None` if neither of its bodies moves.
    pub(crate) fn row_of(&self, record: &Collision, offset: f64) -> Option<Row> {
        let place = |body: BodyId| u32::try_from(self.place(body)?).ok().map(ProblemBody);
        let sides = record.bodies().map(place);
        let row = Row::between(sides, &record.motion.kinematics.jacobian, offset)?;
        Some(if record.parties.bilateral { row.bilateral() } else { row })
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
