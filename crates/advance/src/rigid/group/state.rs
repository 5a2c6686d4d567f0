//! A group: bodies that share their steps because rows or force laws couple them.

use crate::ode::{Accepted, SegmentPolynomial};
use crate::rigid::connectors::store::Stop;
use crate::rigid::contacts::friction::Axis;
use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::ActiveRow;
use crate::rigid::group::loops::Loops;
use crate::rigid::group::singular::Kept;
use crate::rigid::group::stiffness::Stiffness;
use crate::rigid::group::tree::JointTree;
use crate::time::Time;
use halfgap_collision::{BodyId, ConnectorId};
use halfgap_contact::{ActiveRows, ThirdSide};

/// Work of forces without a potential, which is integrated with the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Work {
    /// Of a force law.
    Law(usize),
    /// Of the damping of free flight.
    Damping,
    /// Of the friction of a contact that slips, by its row in the group.
    Friction(u32),
    /// Of surfaces that run.
    Surfaces,
    /// Of drives and motors.
    Drives,
    /// Of dry friction in joints that move.
    Rubbing,
}

/// Event that ends a group's segment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum SegmentEnd {
    /// The force of a row falls to zero, or that of an anchor rises to its bound.
    Release(usize),
    /// A contact runs off its features, or a rail's piece ends.
    Change(usize),
    /// A contact that touches without force sinks.
    Sink(usize),
    /// A unilateral connector within the group closes.
    Stop(ConnectorId),
    /// A force law changes branch.
    Switch,
    /// The slip of a contact along an axis stops.
    SlipStop(usize, Axis),
    /// A joint with dry friction stops, or one with a motor comes to its speed.
    PullStop(usize),
}

/// Bodies with a common segment.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Group {
    /// Its bodies, ascending.
    pub(super) bodies: Vec<BodyId>,
    /// The active rows: independent ones of the contacts, and every row of the connectors.
    pub(super) rows: Vec<ActiveRow>,
    /// Rows that follow from others, each with the forces that it has as long as the group lasts.
    pub(super) spares: Vec<ActiveRow>,
    /// Rows that depend on others for now, and share their forces as the event found them: the row and its force [N].
    pub(super) prescribed: Vec<(u32, f64)>,
    /// True for each row that is one of a lock, next to which rows may be spare; empty where nothing sticks.
    pub(super) locks: Vec<bool>,
    /// What forces of spare rows add to those of the others [N]; empty where there is none.
    pub(super) stress: Vec<f64>,
    /// Places in `bodies` of the two bodies of each row; `None` for one that cannot move.
    pub(super) sides: Vec<[Option<u32>; 2]>,
    /// Third sides of rows, with the places of their bodies.
    pub(super) thirds: Vec<ThirdSide>,
    /// Contacts within the group that touch without force, each with the gap [m] below which it fires.
    pub(super) idle: Vec<ActiveRow>,
    pub(super) stops: Vec<Stop>,
    /// Motors, and dry friction in joints, that act with all their force.
    pub(super) pulls: Vec<Pull>,
    /// Rows of coordinates that are driven, ascending.
    pub(super) driven: Vec<usize>,
    /// Force laws that act on its bodies, ascending.
    pub(super) force_laws: Vec<usize>,
    /// Bodies that are moved and that rows, contacts without force, stops or laws of it tell of.
    pub(super) moved: Vec<BodyId>,
    pub(super) works: Vec<Work>,
    pub(super) active: ActiveRows,
    /// The tree in whose coordinates it is stepped, if its bodies hang together by pins.
    pub(super) tree: JointTree,
    /// Whether its connectors close a loop.
    pub(super) loops: Loops,
    /// Kept shares of the rows of its loops, which tell of bifurcation points (`singular`).
    pub(super) kept: Kept,
    /// Number of rows that depend on others all along, where such rows are soft and share their force.
    pub(super) dependent: usize,
    /// Time at which its segment starts.
    pub(super) start: Time,
    /// Length of the segment [s].
    pub(super) span: f64,
    /// Position (x, y, angle) of each body, then velocities likewise, then works.
    pub(super) state: Vec<f64>,
    /// Rates of `state` at the start of the segment.
    pub(super) rates: Vec<f64>,
    /// State at the end of the segment.
    pub(super) end_state: Vec<f64>,
    /// Rates at the end of the segment.
    pub(super) end_rates: Vec<f64>,
    /// Force [N] of each row at the start of the segment.
    pub(super) forces: Vec<f64>,
    /// Force [N] of each row at the end of the segment.
    pub(super) end_forces: Vec<f64>,
    /// Another group was ended at the time at which this one was made, because a contact pulled from the start; here it
    /// may pull again.
    pub(super) is_patient: bool,
    /// Distance [m] by which each row had run off its features when that was first seen; 0 if it had not.
    pub(super) overrun: Vec<f64>,
    /// Force [N] by which each row pulled when that was first seen; 0 if it did not.
    pub(super) pulled: Vec<f64>,
    /// x, y and angle of each body along the segment.
    pub(super) paths: Vec<[SegmentPolynomial; 3]>,
    /// Velocities of the bodies, in the order of the state, and then works [J], along the segment. The derivatives of
    /// `paths` are no substitute: they contain the displacement of the end by its projection, which is much over a
    /// short step.
    pub(super) rate_paths: Vec<SegmentPolynomial>,
    /// Length of the next step to try [s]; `None` if nothing is known.
    pub(super) next_step: Option<f64>,
    /// Length [s] of the next step of the method asked for, while brief steps are made.
    pub(super) full_step: Option<f64>,
    /// Time at which the group was made.
    pub(super) made: Time,
    /// Its steps are brief: the next event is so near that a step of few stages reaches it.
    pub(super) is_brief: bool,
    /// No event can end its segments early: dense output may be postponed until it is asked for.
    pub(super) is_unwatched: bool,
    /// A point follows a rail whose curvature has kinks, over which a method of high order gains little.
    pub(super) has_kinks: bool,
    pub(super) stiffness: Stiffness,
    /// Change of each body's acceleration per displacement [1/s^2], as the last probe found it; empty where none was
    /// needed, and in groups with contacts.
    pub(super) roughness: Vec<f64>,
    /// The last accepted step of the group as it is now.
    pub(super) accepted: Option<Accepted>,
    /// Length [s] of the last step, if along it neither the forces of contacts varied nor the gaps of those without
    /// force, and no force law acts on the group.
    pub(super) steady_step: Option<f64>,
    /// Largest acceleration [m/s^2] of a point by forces other than those of rows, as last evaluated.
    pub(super) free_acceleration: f64,
    /// Length [m] over which the forces of laws vary, as last evaluated; infinite where they vary over no less than the
    /// size of the bodies.
    pub(super) force_length: f64,
    /// The same length of the laws that name one body.
    pub(super) field_length: f64,
    /// Energy [J] that the projection of the end has added.
    pub(super) projected: f64,
    /// Largest error [m] of a connector, in the middle of the segment, or at its end if the middle was not evaluated.
    pub(super) largest_error: f64,
    /// The least gap [m] of an active contact within the segment, if there is one and its gap was evaluated there.
    pub(super) least_gap: Option<f64>,
    /// The event that ends the segment early, if there is one, and its offset [s].
    pub(super) event: Option<(f64, SegmentEnd)>,
    /// Offset [s] up to which the stages of the step show that no contact loses its force, while the search for events
    /// has not gone further.
    pub(super) look: Option<f64>,
}

impl Group {
    /// Penetration [m] of the deepest active contact; 0 if there is none. Rows that contradict each other do not keep to
    /// their gaps.
    pub(crate) fn depth(&self) -> f64 {
        self.least_gap.map_or(0.0, |gap| (-gap).max(0.0))
    }

    /// Empties the group, and keeps the capacity of its buffers.
    pub(crate) fn clear(&mut self) {
        let mut old = std::mem::take(self);
        old.tree.clear();
        old.loops.clear();
        old.kept.clear();
        *self = Self {
            bodies: emptied(old.bodies),
            rows: emptied(old.rows),
            spares: emptied(old.spares),
            prescribed: emptied(old.prescribed),
            locks: emptied(old.locks),
            stress: emptied(old.stress),
            sides: emptied(old.sides),
            thirds: emptied(old.thirds),
            idle: emptied(old.idle),
            stops: emptied(old.stops),
            pulls: emptied(old.pulls),
            driven: emptied(old.driven),
            force_laws: emptied(old.force_laws),
            moved: emptied(old.moved),
            works: emptied(old.works),
            active: old.active,
            tree: old.tree,
            loops: old.loops,
            kept: old.kept,
            state: emptied(old.state),
            rates: emptied(old.rates),
            end_state: emptied(old.end_state),
            end_rates: emptied(old.end_rates),
            forces: emptied(old.forces),
            end_forces: emptied(old.end_forces),
            overrun: emptied(old.overrun),
            pulled: emptied(old.pulled),
            paths: emptied(old.paths),
            rate_paths: emptied(old.rate_paths),
            roughness: emptied(old.roughness),
            ..Self::default()
        };
    }

    /// The body under whose id the group is stored.
    pub(crate) fn leader(&self) -> BodyId {
        self.bodies[0]
    }

    /// Finds the places of the bodies of its rows.
    pub(crate) fn find_sides(&mut self) {
        let bodies = &self.bodies;
        let place = |body| bodies.binary_search(&body).ok().and_then(|place| u32::try_from(place).ok());
        self.sides.clear();
        self.sides.extend(self.rows.iter().map(|row| row.bodies.map(place)));
        let third = |(row, active): (u32, &ActiveRow)| {
            let (body, coefficient) = active.third?;
            Some(ThirdSide { row, body: place(body)?, coefficient })
        };
        self.thirds.clear();
        self.thirds.extend((0..).zip(&self.rows).filter_map(third));
    }

    /// Number of components of its state: positions, velocities, works.
    pub(crate) fn dimension(&self) -> usize {
        6 * self.bodies.len() + self.works.len()
    }

    /// Index of the first velocity in its state.
    pub(crate) fn velocities(&self) -> usize {
        3 * self.bodies.len()
    }

    /// Works along the segment [J].
    pub(crate) fn work_paths(&self) -> &[SegmentPolynomial] {
        &self.rate_paths[self.velocities().min(self.rate_paths.len())..]
    }

    /// Time at which the segment ends, is interrupted by an event of the group itself, or has to be searched further.
    pub(crate) fn due(&self) -> Time {
        let end = self.event.map_or(self.span, |(offset, _)| offset);
        self.start.plus(self.look.unwrap_or(end))
    }

    /// Time at which the segment ends.
    pub(crate) fn end(&self) -> Time {
        self.start.plus(self.span)
    }
}

/// An emptied list, which keeps its capacity.
fn emptied<T>(mut list: Vec<T>) -> Vec<T> {
    list.clear();
    list
}

#[cfg(test)]
impl Group {
    pub(crate) fn state_mut(&mut self) -> &mut Vec<f64> {
        &mut self.state
    }

    pub(crate) fn end_state_mut(&mut self) -> &mut Vec<f64> {
        &mut self.end_state
    }

    pub(crate) fn forces_mut(&mut self) -> [&mut Vec<f64>; 2] {
        [&mut self.forces, &mut self.end_forces]
    }

    pub(crate) fn idle_mut(&mut self) -> &mut Vec<ActiveRow> {
        &mut self.idle
    }

    pub(crate) fn make_idle(&mut self) {
        self.idle = std::mem::take(&mut self.rows);
    }

    pub(crate) fn forget_structure(&mut self) {
        self.active.set_structure(&[], &self.sides);
    }

    pub(crate) fn set_force_laws(&mut self, force_laws: Vec<usize>) {
        self.force_laws = force_laws;
    }

    pub(crate) fn set_times(&mut self, start: Time, made: Time) {
        (self.start, self.made) = (start, made);
    }

    pub(crate) fn set_span(&mut self, span: f64) {
        self.span = span;
    }

    pub(crate) fn end_at_start(&mut self) {
        self.end_state.clone_from(&self.state);
        self.end_rates.clone_from(&self.rates);
        self.span = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::group::groups::group_of;
    use crate::rigid::test_scene::resting_discs;

    #[test]
    fn a_group_that_was_used_knows_nothing_of_it() {
        let rooms = resting_discs(&[0.0]);
        let mut used = group_of(&rooms.assembly, &rooms.groups, BodyId(1)).expect("it rests").clone();
        assert!(used.free_acceleration > 0.0 && used.span > 0.0);
        let active = used.active.clone();
        used.clear();
        let mut fresh = Group::default();
        // The order of the rows is found anew for each group.
        (fresh.active, fresh.tree, fresh.kept) = (active, used.tree.clone(), used.kept.clone());
        fresh.loops = used.loops.clone();
        assert_eq!(format!("{used:?}"), format!("{fresh:?}"));
    }
}
