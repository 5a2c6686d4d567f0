//! A group: bodies that share their steps because rows or force laws couple them.

use super::loops::Loops;
use super::rows::HeldRow;
use super::singular::Kept;
use super::stiff::Stiffness;
use super::tree::JointTree;
use crate::ode::{Accepted, SegmentPolynomial};
use crate::time::Time;
use halfgap_collision::{BodyId, ConnectorId, RailHint};
use halfgap_contact::HeldRows;

/// Work that has no potential and is integrated with the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    /// Of a force law.
    Law(usize),
    /// Of the damping of free flight.
    Damping,
}

/// What ends a group's segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SegmentEnd {
    /// The force of a row falls to zero.
    Release(usize),
    /// A contact runs off its features, or a rail's piece ends.
    Change(usize),
    /// A contact that is touched without force sinks.
    Sink(usize),
    /// A unilateral connector within the group closes.
    Stop(ConnectorId),
    /// A force law changes branch.
    Switch,
}

/// A stop of a rail that is not held.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    pub(crate) id: ConnectorId,
    /// Piece of the rail.
    pub(crate) hint: Option<RailHint>,
    /// How far [m] it may sink before it fires: more than nothing where it is touched without force.
    pub(crate) slack: f64,
    /// Where its point has come to has been noted: its body is about to leave the segment.
    pub(crate) is_noted: bool,
}

/// Bodies with a common segment.
#[derive(Clone, Debug, Default)]
pub(crate) struct Group {
    /// Its bodies, ascending.
    pub(crate) bodies: Vec<BodyId>,
    /// The rows that are held: independent ones, and every row of its connectors.
    pub(crate) rows: Vec<HeldRow>,
    /// Places in `bodies` of the two bodies of each row; `None` for one that cannot move.
    pub(crate) sides: Vec<[Option<u32>; 2]>,
    /// Contacts within the group that are touched without force, each with the gap [m] below which it fires.
    pub(crate) idle: Vec<HeldRow>,
    pub(crate) stops: Vec<Stop>,
    /// Force laws that act on its bodies, ascending.
    pub(crate) laws: Vec<usize>,
    pub(crate) works: Vec<Work>,
    pub(crate) held: HeldRows,
    /// In whose coordinates it is stepped, if it hangs together by pins alone.
    pub(crate) tree: JointTree,
    /// Whether its connectors close any.
    pub(crate) loops: Loops,
    /// What rows of loops keep that depend on each other for a moment.
    pub(crate) kept: Kept,
    /// How many rows depend on others all along, where such rows share what they hold.
    pub(crate) dependent: usize,
    /// When its segment started.
    pub(crate) start: Time,
    /// Length of the segment [s].
    pub(crate) span: f64,
    /// Position (x, y, angle) of each body, then velocities likewise, then works.
    pub(crate) state: Vec<f64>,
    pub(crate) rates: Vec<f64>,
    /// The same at the end of the segment.
    pub(crate) end_state: Vec<f64>,
    pub(crate) end_rates: Vec<f64>,
    /// Force [N] of each row at the start of the segment.
    pub(crate) forces: Vec<f64>,
    /// Force [N] of each row at the end of the segment.
    pub(crate) end_forces: Vec<f64>,
    /// Another group was ended when this one was made, as a contact pulled from the start: it may again.
    pub(crate) is_patient: bool,
    /// How far [m] each row was off its features already when that was first seen; 0 if it was not.
    pub(crate) overrun: Vec<f64>,
    /// By what force [N] each row pulled already when that was first seen; 0 if it did not.
    pub(crate) pulled: Vec<f64>,
    /// x, y and angle of each body along the segment.
    pub(crate) paths: Vec<[SegmentPolynomial; 3]>,
    /// Their velocities, by place as in the state, and then works [J], along the segment. The paths' own
    /// derivatives hold what a projection has moved the end by, too: over a short step that is much.
    pub(crate) rate_paths: Vec<SegmentPolynomial>,
    /// Length of the next step to try [s]; `None` if nothing is known.
    pub(crate) next_step: Option<f64>,
    /// The same, of the method that is asked for, while a brief one goes on.
    pub(crate) full_step: Option<f64>,
    /// When the group was made.
    pub(crate) made: Time,
    /// The next event is near: a step of few stages reaches it.
    pub(crate) is_brief: bool,
    /// Nothing ends its segments early: dense output may wait until somebody looks.
    pub(crate) is_unwatched: bool,
    /// A point follows a rail whose curvature has kinks, over which a method of high order gains nothing.
    pub(crate) has_kinks: bool,
    pub(crate) stiffness: Stiffness,
    /// By how much [1/s^2] the acceleration of each body varied last where the bodies were moved by a little;
    /// empty where nobody had to look, and among contacts.
    pub(crate) roughness: Vec<f64>,
    /// The last step of the group as it is now.
    pub(crate) accepted: Option<Accepted>,
    /// Its length [s], if no contact varied along it: neither its force nor, of those without force, its gap.
    pub(crate) steady_step: Option<f64>,
    /// Largest acceleration [m/s^2] that forces other than those of rows gave last.
    pub(crate) free_acceleration: f64,
    /// Length [m] over which forces of laws varied last, without end where they vary over no less than bodies
    /// are large.
    pub(crate) force_length: f64,
    /// Energy [J] that the projection of the end changed.
    pub(crate) projected: f64,
    /// Largest error of a held gap [m], in the middle of the segment, or at its end if nobody looked in between.
    pub(crate) largest_error: f64,
    /// The least gap [m] of a held contact in the middle of the segment, if there is one and somebody looked.
    pub(crate) least_gap: Option<f64>,
    /// What ends the segment early, if something does, and its offset [s].
    pub(crate) event: Option<(f64, SegmentEnd)>,
    /// Offset [s] up to which no contact can lose its force, as the stages of the step tell, while nobody has
    /// looked further.
    pub(crate) look: Option<f64>,
}

impl Group {
    /// How deep [m] a held contact lies below where its bodies touch: rows that contradict each other do not
    /// keep to their gaps.
    pub(crate) fn depth(&self) -> f64 {
        self.least_gap.map_or(0.0, |gap| (-gap).max(0.0))
    }

    /// Forgets everything but the room of its buffers.
    pub(crate) fn clear(&mut self) {
        let mut old = std::mem::take(self);
        old.tree.clear();
        old.loops.clear();
        old.kept.clear();
        *self = Self {
            bodies: emptied(old.bodies),
            rows: emptied(old.rows),
            sides: emptied(old.sides),
            idle: emptied(old.idle),
            stops: emptied(old.stops),
            laws: emptied(old.laws),
            works: emptied(old.works),
            held: old.held,
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

    /// The body by which the group is found.
    pub(crate) fn leader(&self) -> BodyId {
        self.bodies[0]
    }

    /// Finds the places of the bodies of its rows.
    pub(crate) fn find_sides(&mut self) {
        let bodies = &self.bodies;
        let place = |body| bodies.binary_search(&body).ok().and_then(|place| u32::try_from(place).ok());
        self.sides.clear();
        self.sides.extend(self.rows.iter().map(|row| row.bodies.map(place)));
    }

    /// Numbers in its state: positions, velocities, works.
    pub(crate) fn dimension(&self) -> usize {
        6 * self.bodies.len() + self.works.len()
    }

    /// Where the velocities start in its state.
    pub(crate) fn velocities(&self) -> usize {
        3 * self.bodies.len()
    }

    /// Works along the segment [J].
    pub(crate) fn work_paths(&self) -> &[SegmentPolynomial] {
        &self.rate_paths[self.velocities().min(self.rate_paths.len())..]
    }

    /// When the segment ends, is interrupted by an event of the group itself, or has to be looked at further.
    pub(crate) fn due(&self) -> Time {
        let end = self.event.map_or(self.span, |(offset, _)| offset);
        self.start.plus(self.look.unwrap_or(end))
    }

    /// When the segment ends.
    pub(crate) fn end(&self) -> Time {
        self.start.plus(self.span)
    }
}

/// A list without its entries, but with their room.
fn emptied<T>(mut list: Vec<T>) -> Vec<T> {
    list.clear();
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::test_scene::resting_discs;

    #[test]
    fn a_group_that_was_used_knows_nothing_of_it() {
        let system = resting_discs(&[0.0]);
        let mut used = system.group_of(BodyId(1)).expect("it rests").clone();
        assert!(used.free_acceleration > 0.0 && used.span > 0.0);
        let held = used.held.clone();
        used.clear();
        let mut fresh = Group::default();
        // Whose rows are sorted how is found anew with each group.
        (fresh.held, fresh.tree, fresh.kept) = (held, used.tree.clone(), used.kept.clone());
        fresh.loops = used.loops.clone();
        assert_eq!(format!("{used:?}"), format!("{fresh:?}"));
    }
}
