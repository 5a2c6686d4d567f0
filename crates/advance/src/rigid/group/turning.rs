//! A group goes from one segment to the next.

use crate::ode::Method;
use crate::rigid::contacts::rows::{ActiveRow, RowSource};
use crate::rigid::group::stage::set_body_state;
use crate::rigid::group::state::{Group, SegmentEnd};
use crate::time::Time;
use halfgap_collision::{BodyId, BodyState, Connector, ConnectorId, RailHint};
use halfgap_contact::InverseInertia;

impl Group {
    /// Prepares the first segment, which starts at a time; `inertias` are those of the bodies.
    pub(crate) fn prepare(
        &mut self,
        now: Time,
        is_patient: bool,
        (connectors, inertias): (&[Connector], &[InverseInertia]),
    ) {
        (self.start, self.made, self.is_patient) = (now, now, is_patient);
        self.find_sides();
        let mut active = std::mem::take(&mut self.active);
        active.set_structure_with_held(inertias, &self.sides, &self.thirds, self.held(connectors));
        self.active = active;
        // The projection acts on the end of a segment: a segment of no length ends here.
        let dimension = self.dimension();
        self.end_state.clear();
        self.end_state.resize(dimension, 0.0);
        (self.span, self.projected) = (0.0, 0.0);
    }

    /// Sets the state of a body, given by its place, at the end of the segment.
    pub(crate) fn set_end(&mut self, place: usize, state: &BodyState) {
        let count = self.bodies.len();
        set_body_state(&mut self.end_state, count, place, state);
    }

    /// Lets the segment start where the segment of no length before it ends; returns the energy [J] that its projection
    /// has added.
    pub(crate) fn set_off(&mut self) -> f64 {
        std::mem::swap(&mut self.state, &mut self.end_state);
        std::mem::take(&mut self.projected)
    }

    /// Lets the next segment start where this one has ended.
    pub(crate) fn turn_over(&mut self, method: Method) {
        self.start = self.end();
        self.end_brief();
        self.choose_stiffness(method);
        let first_work = 2 * self.velocities();
        std::mem::swap(&mut self.state, &mut self.end_state);
        std::mem::swap(&mut self.rates, &mut self.end_rates);
        std::mem::swap(&mut self.forces, &mut self.end_forces);
        self.state[first_work..].fill(0.0);
    }

    /// Leaves implicit steps, which have failed, with the step that was to be made.
    pub(crate) fn retry_explicitly(&mut self, next_step: Option<f64>, method: Method) {
        self.next_step = next_step;
        self.leave_stiffness(method);
    }

    /// Forgets the error in the middle of the segment, which is not reached.
    pub(crate) fn forget_error(&mut self) {
        self.largest_error = 0.0;
    }

    /// Sets the largest error [m] of a connector.
    pub(crate) fn set_largest_error(&mut self, error: f64) {
        self.largest_error = error;
    }

    /// Sets the length [s] of the next step to try.
    pub(crate) fn set_next_step(&mut self, step: Option<f64>) {
        self.next_step = step;
    }

    /// Notes the event that ends the segment early, if there is one.
    pub(crate) fn set_event(&mut self, event: Option<(f64, SegmentEnd)>) {
        self.event = event;
    }

    /// Notes the offset [s] up to which no contact loses its force, while the search has not gone further.
    pub(crate) fn set_look(&mut self, look: Option<f64>) {
        self.look = look;
    }

    /// Notes that the gaps of contacts without force vary along the segment.
    pub(crate) fn forget_steadiness(&mut self) {
        self.steady_step = None;
    }

    /// Lowers the gap [m] at which a contact without force fires.
    pub(crate) fn lower_idle_gap(&mut self, row: usize, way: f64) {
        let gap = self.idle[row].gap - way;
        self.idle[row].set_gap(gap);
    }

    /// Lends out how far rows had run off their features when that was first seen.
    pub(crate) fn lend_overrun(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.overrun)
    }

    /// Takes that back.
    pub(crate) fn take_back_overrun(&mut self, overrun: Vec<f64>) {
        self.overrun = overrun;
    }

    /// Lends out by how much rows pulled when that was first seen.
    pub(crate) fn lend_pulled(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.pulled)
    }

    /// Takes that back.
    pub(crate) fn take_back_pulled(&mut self, pulled: Vec<f64>) {
        self.pulled = pulled;
    }

    /// Notes the places of the points of rails at the start of the segment, found from the hint of each by `found`; a
    /// stop's is handled by `of_stop`.
    pub(crate) fn renew_hints(
        &mut self,
        is_wanted: impl Fn(&ActiveRow) -> bool,
        found: impl Fn(&[BodyId], &[f64], ConnectorId, Option<&RailHint>) -> Option<RailHint>,
        of_stop: impl Fn(ConnectorId, Option<RailHint>) -> Option<RailHint>,
    ) {
        let Self { bodies, state, rows, stops, .. } = self;
        for stop in stops {
            stop.renew(of_stop(stop.id, found(bodies, state, stop.id, stop.hint.as_ref())));
        }
        for row in rows.iter_mut().filter(|row| is_wanted(row)) {
            if let RowSource::Connector(id, _) = row.source {
                row.set_hint(found(bodies, state, id, row.hint.as_ref()).map(RailHint::staying));
            }
        }
    }

    /// Notes that the place to which the point of a stop has come is known.
    pub(super) fn note_stop(&mut self, place: usize) {
        self.stops[place].note();
    }
}
