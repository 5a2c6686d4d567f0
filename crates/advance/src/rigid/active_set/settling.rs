//! The complementarity problem of an event's candidates: its solvers and buffers, its initial guess, and the rows that
//! result. `settle` decides which rows are candidates, and which of them become active.

use crate::rigid::active_set::exclusion::Excluded;
use crate::rigid::active_set::levers::Levers;
use crate::rigid::active_set::pulling::Pulling;
use crate::rigid::active_set::redundant::Redundant;
use crate::rigid::active_set::slips::Slip;
use crate::rigid::books::report::RowForce;
use crate::rigid::contacts::friction::Axis;
use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::ActiveRow;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::NEGLIGIBLE;
use crate::rigid::zeno::memory::StoppedSlip;
use halfgap_collision::ConnectorId;
use halfgap_contact::{Auto, Problem, Settings, Solution, SolveError, Solver, WarmStart};

/// Residual that is then accepted, relative to the largest acceleration: the answer only decides which rows are active.
const LENIENT_RESIDUAL: f64 = 1e-6;

/// Solvers for contact forces, with their buffers.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Settling {
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) problem: Problem,
    pub(super) solution: Solution,
    pub(super) solver: Auto,
    /// Solver for the forces at the start, where nothing is known of perhaps thousands of rows.
    pub(super) sharing: Auto,
    /// The event is the start: `sharing` solves it.
    pub(super) is_start: bool,
    /// A group was ended at the present time as soon as it was made, because one of its contacts pulled.
    pub(super) has_pulled: bool,
    /// Solver for contacts that contradict each other by more than rounding, but by little.
    pub(super) lenient: Auto,
    /// Indices of the records that enter the problem.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) candidates: Vec<usize>,
    /// The friction of the candidates that have some.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) slips: Vec<Slip>,
    /// Motors and dry friction in joints.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) pulls: Vec<Pulling>,
    /// Those that cannot hold from this event on, and the side, 1 or -1, to which they give way.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) given_up: Vec<(ConnectorId, f64)>,
    /// Rows of those that hold.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) held: Vec<ActiveRow>,
    /// Those that act with all their force.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) pulled: Vec<Pull>,
    /// The problem is that of a jump: contacts that slip may stop.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) jumps: bool,
    /// Share [-] by which the bounds of contacts that may stick are less than they are.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) slack: f64,
    /// Records that are no candidates, as there are forces without them alone.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) loose: Vec<usize>,
    /// Records whose contacts slip from now on, each along an axis to a side, as there are forces if they do.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) yielding: Vec<(usize, Axis, f64)>,
    /// Records whose contacts have begun to slip in this event, with the axis and the side to which they do.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) given_way: Vec<(usize, Axis, f64)>,
    /// Slips that have come to a stop at the time of the event.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) stopped: Vec<StoppedSlip>,
    /// Records of contacts whose motion is not unique, with the speeds [m/s] at which they slip.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) undecided: Vec<(usize, f64)>,
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) excluded: Vec<Excluded>,
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) levers: Levers,
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) redundant: Redundant,
    /// Whether each record of the region is likely to carry a force, if that is known.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) likely: Vec<Option<bool>>,
    /// For each record, true if it still opened after low hops were stilled: it leaves.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) leaving: Vec<bool>,
    /// Force [N] of each record in the last solve of the event, if it took part; before the first solve, the force at
    /// which its contact was cut.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) forces: Vec<Option<f64>>,
    /// The same along the axes of contacts.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) along: Vec<[Option<f64>; 2]>,
    /// Contacts that were cut in the event, sorted, with their forces [N] along the normal, and along both axes.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) ended: Vec<(Touch, [f64; 3])>,
    /// The solver's initial guess for the candidates.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) guess: WarmStart,
    /// The active rows, with the index of each one's record.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) active: Vec<(usize, ActiveRow)>,
    /// The contacts among the active rows, sorted.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) touches: Vec<Touch>,
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) force_laws: Vec<usize>,
    /// Loads of the region's bodies [N].
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) gross: Vec<f64>,
    /// Accelerations of the region's bodies under the forces of the candidates.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) pushed: Vec<[f64; 3]>,
}

impl Default for Settling {
    fn default() -> Self {
        let settings = Settings {
            // Nearly redundant contacts that contradict each other get modest forces.
            contradiction: halfgap_contact::Contradiction::LeastSquares,
            // Rows that carry force become active, and should not depend on each other.
            selection: halfgap_contact::ForceSelection::Pivoted,
            ..Settings::default()
        };
        let solver = |settings| Auto::new(settings).expect("the settings are valid");
        let sharing = Settings { selection: halfgap_contact::ForceSelection::Quickest, ..settings };
        let lenient = Settings { inconsistency: NEGLIGIBLE, natural_residual: LENIENT_RESIDUAL, ..settings };
        Self {
            problem: Problem::new(),
            solution: Solution::new(),
            solver: solver(settings),
            sharing: solver(sharing),
            is_start: false,
            has_pulled: false,
            lenient: solver(lenient),
            candidates: Vec::new(),
            slips: Vec::new(),
            pulls: Vec::new(),
            given_up: Vec::new(),
            held: Vec::new(),
            pulled: Vec::new(),
            jumps: false,
            slack: 0.0,
            loose: Vec::new(),
            yielding: Vec::new(),
            given_way: Vec::new(),
            stopped: Vec::new(),
            undecided: Vec::new(),
            excluded: Vec::new(),
            levers: Levers::default(),
            redundant: Redundant::default(),
            likely: Vec::new(),
            leaving: Vec::new(),
            forces: Vec::new(),
            along: Vec::new(),
            ended: Vec::new(),
            guess: WarmStart::new(),
            active: Vec::new(),
            touches: Vec::new(),
            force_laws: Vec::new(),
            gross: Vec::new(),
            pushed: Vec::new(),
        }
    }
}

impl Settling {
    /// Notes whether a group was ended at the present time as soon as it was made, because one of its contacts pulled.
    pub(crate) fn note_pull(&mut self, has_pulled: bool) {
        self.has_pulled = has_pulled;
    }

    /// Solves for the forces of the candidates, starting from those that are likely to carry some, and notes the
    /// forces.
    pub(super) fn solve_strictly(&mut self) -> Result<(), SolveError> {
        if self.forces.is_empty() {
            self.guess.guess(self.candidates.iter().map(|&index| self.likely[index]));
        } else {
            let along = |slip: &Slip| {
                slip.number.map(|_| self.along.get(slip.record).and_then(|along| along[slip.axis as usize]))
            };
            let normal = self.candidates.iter().map(|&index| self.forces[index]);
            let of_pulls = self.pulls.iter().map(|_| None);
            self.guess.guess_forces(normal.chain(self.slips.iter().filter_map(along)).chain(of_pulls));
        }
        let solver = if self.is_start { &mut self.sharing } else { &mut self.solver };
        solver.solve_from(&self.problem, &self.guess, &mut self.solution).or_else(|error| match error {
            // All modes were tried.
            SolveError::NoModes { .. } => Err(error),
            _ => solver.solve(&self.problem, &mut self.solution),
        })?;
        self.forces.resize(self.likely.len(), None);
        for (place, &index) in self.candidates.iter().enumerate() {
            self.forces[index] = Some(self.solution.force[place]);
        }
        if !self.slips.is_empty() {
            self.along.resize(self.likely.len(), [None; 2]);
        }
        for slip in &self.slips {
            let share = slip.share();
            let of_slipping = share.map(|share| share * self.solution.force[slip.place]);
            self.along[slip.record][slip.axis as usize] =
                slip.number.map(|number| self.solution.force[number]).or(of_slipping);
        }
        Ok(())
    }

    /// Solves for the forces of candidates that contradict each other by more than rounding.
    pub(super) fn solve_leniently(&mut self) -> Result<(), SolveError> {
        self.lenient.solve(&self.problem, &mut self.solution)
    }

    /// Starts an event: sets for each record of its region whether it is likely to carry a force, if that is known.
    pub(crate) fn set_likely(&mut self, likely: impl Iterator<Item = Option<bool>>) {
        self.likely.clear();
        self.likely.extend(likely);
        self.leaving.clear();
        self.leaving.resize(self.likely.len(), false);
        self.forces.clear();
        self.along.clear();
    }

    /// Releases the active records that open, however low they hop.
    pub(crate) fn let_leave(&mut self, opens: impl Fn(usize) -> bool) {
        for &(record, _) in &self.active {
            self.leaving[record] |= opens(record);
        }
    }

    pub(super) fn leaves(&self, record: usize) -> bool {
        self.leaving.get(record).is_some_and(|leaves| *leaves)
    }

    /// Starts the next solve from the forces at which contacts were cut, if there were any.
    pub(crate) fn expect_forces(&mut self, region: &Region, ended: &[RowForce]) {
        self.ended.clear();
        let forces = |row: &RowForce| {
            let slip = row.friction.map_or(0.0, |friction| friction.force);
            [row.force, slip, row.rolling.map_or(0.0, |rolling| rolling.moment / rolling.radius)]
        };
        let told = |row: &RowForce| Some((Touch::new(row.bodies, row.features?), forces(row)));
        self.ended.extend(ended.iter().filter_map(told));
        if self.ended.is_empty() {
            return;
        }
        self.ended.sort_unstable_by_key(|(touch, _)| *touch);
        let found = region.records().iter().map(|record| {
            let touch = Touch::of(record)?;
            let place = self.ended.binary_search_by_key(&touch, |(touch, _)| *touch).ok()?;
            Some(self.ended[place].1)
        });
        for forces in found {
            self.forces.push(forces.map(|[normal, ..]| normal));
            self.along.push(forces.map_or([None; 2], |[_, slip, turn]| [Some(slip), Some(turn)]));
        }
    }

    /// True if a contact is active from now on.
    pub(crate) fn is_active(&self, touch: Touch) -> bool {
        self.touches.binary_search(&touch).is_ok()
    }

    pub(super) fn list_touches(&mut self) {
        self.touches.clear();
        self.touches.extend(self.active.iter().filter_map(|(_, row)| row.touch()));
        self.touches.sort_unstable();
    }

    /// Solves another problem with the solvers of this one.
    pub(crate) fn solve(&mut self, problem: &Problem) -> Result<(), SolveError> {
        self.solver
            .solve(problem, &mut self.solution)
            .or_else(|_| self.lenient.solve(problem, &mut self.solution))
    }

    /// Acceleration [m/s^2] with which the only candidate would close without a force; `None` if there are others or it
    /// would not close.
    pub(crate) fn closing_acceleration(&self) -> Option<f64> {
        match (self.candidates.as_slice(), self.problem.offset()) {
            ([_], [offset, ..]) if *offset < 0.0 => Some(-offset),
            _ => None,
        }
    }
}

impl Settling {
    /// Holds the active contacts at the gaps of their records, measured anew.
    pub(crate) fn hold_where_they_are(&mut self, region: &Region) {
        for (index, row) in self.active.iter_mut().filter(|(_, row)| row.touch().is_some()) {
            row.set_gap(region.records()[*index].geometry.distance);
        }
    }

    /// Lets all records be candidates, and all contacts without slip stick.
    pub(crate) fn forget_loose(&mut self) {
        self.loose.clear();
        self.yielding.clear();
    }

    /// Sets the slips that have come to a stop at the time of the event: they do not go on to the same side.
    pub(crate) fn set_stopped(&mut self, stopped: &[StoppedSlip]) {
        self.stopped.clear();
        self.stopped.extend_from_slice(stopped);
    }

    /// True if a candidate slips.
    pub(crate) fn any_slips(&self) -> bool {
        self.slips.iter().any(|slip| slip.side.is_some())
    }

    /// Rows of motors and of dry friction in joints that hold.
    #[inline]
    pub(crate) fn held(&self) -> &[ActiveRow] {
        &self.held
    }

    /// Motors and dry friction in joints that act with all their force.
    #[inline]
    pub(crate) fn pulled(&self) -> &[Pull] {
        &self.pulled
    }

    /// The active rows, with the index of each one's record.
    #[inline]
    pub(crate) fn active(&self) -> &[(usize, ActiveRow)] {
        &self.active
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::contacts::pairs::is_likely;
    use crate::rigid::event::life::dissolve;
    use crate::rigid::region::collecting::collect_region;
    use crate::rigid::test_scene::resting_discs;
    use halfgap_collision::BodyId;
    use halfgap_contact::Row;

    #[test]
    fn a_cut_contact_is_expected_to_carry_its_force_again() {
        let mut rooms = resting_discs(&[0.0, 1.5]);
        let mut work = rooms.work.take().expect("the start has made it");
        dissolve(&mut rooms, BodyId(1));
        collect_region(&rooms.view(), &mut work.region, &[BodyId(2), BodyId(1)], rooms.assembly.now());
        work.settling.set_likely([None, None].into_iter());
        work.settling.expect_forces(&work.region, &rooms.books.told().changes().end);
        let [None, Some(force)] = work.settling.forces[..] else { panic!("{:?}", work.settling.forces) };
        assert!((force - 9.81).abs() < 1e-9, "{force} N");
    }

    #[test]
    fn the_solver_begins_with_what_is_held() {
        let mut rooms = resting_discs(&[0.0, 1.5]);
        let mut work = rooms.work.take().expect("the start has made it");
        collect_region(&rooms.view(), &mut work.region, &[BodyId(1)], rooms.assembly.now());
        let [record] = work.region.records()[..] else { panic!("one disc, one contact") };
        assert_eq!(is_likely(&rooms.pairs, &record), Some(true));
        // Another contact, of which nothing is known, carries a force, too.
        let settling = &mut work.settling;
        settling.problem.clear();
        settling.candidates.clear();
        settling.set_likely([is_likely(&rooms.pairs, &record), None].into_iter());
        for index in 0..2 {
            let body = settling.problem.add_body(rooms.assembly.inertia(BodyId(1))).expect("a fine inertia");
            let row = Row::new(body, [0.0, 1.0, 0.0], -9.81);
            settling.problem.add_row(&row).expect("a row of finite numbers");
            settling.candidates.push(index);
        }
        let mut guess = WarmStart::new();
        settling.solve_strictly().expect("independent rows");
        guess.guess([Some(true), None]);
        assert_eq!(settling.guess, guess);
        // The next solve of the event goes on from the forces found.
        let found = settling.forces.clone();
        assert!(found.iter().all(|force| force.is_some_and(|force| force > 0.0)));
        settling.solve_strictly().expect("independent rows");
        guess.guess_forces(found);
        assert_eq!(settling.guess, guess);
    }
}
