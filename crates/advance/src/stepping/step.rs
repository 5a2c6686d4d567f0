//! From the start of one step to the start of the next.
//!
//! With w- and w+ the velocities in the middles of the steps before and after a moment, h the length of a step, a the acceleration
//! without contacts, and J the rows at that moment,
//!
//! ```text
//! w+ = w- + h a + M^-1 J^T P,      q+ = q + h w+,      J w+ + g/h + h/2 gamma >= 0,   P >= 0, complementary,
//! ```
//!
//! so that gaps g reach their targets at the end of the step to third order: the scheme SHAKE, of second order where motions are
//! smooth, with friction in the same problem. Where contacts have come fast, the velocity at the moment itself is found first: the
//! impact law changes it, and the step sets out from there by half a kick, as in RATTLE.
//!
//! Sources: J.-P. Ryckaert, G. Ciccotti, H. J. C. Berendsen, J. Comput. Phys. 23 (1977) (SHAKE); H. C. Andersen, J. Comput. Phys. 52
//! (1983) (RATTLE); D. E. Stewart, J. C. Trinkle, Int. J. Numer. Meth. Engng. 39 (1996) (friction in the problem of velocities).

use crate::rigid::ForceLaws;
use crate::stepping::bodies::{Bodies, Motion3};
use crate::stepping::books::StepBooks;
use crate::stepping::contacts::Hold;
use crate::stepping::exact::Exact;
use crate::stepping::impacts::Impacts;
use crate::stepping::islands::Islands;
use crate::stepping::kicks::{Kicks, kicked};
use crate::stepping::listing::{Lengths, Listing};
use crate::stepping::pairs::Pairs;
use crate::stepping::projection::project;
use crate::stepping::rows::{Drag, Row, Source};
use crate::stepping::settings::SteppingSettings;
use crate::stepping::sweeps::Sweeps;
use crate::stepping::ties::Ties;
use halfgap_contact::ImpactError;

/// Rounds of sweeps over an island that is too large, or has too many modes, for an exact solution.
const MOST_ROUNDS: u32 = 100;
/// Largest number of rows of an island that is solved exactly.
const LARGEST_EXACT: usize = 60;
/// A contact is slow if it closes no faster than forces make it in so many steps.
const SLOW_STEPS: f64 = 2.0;

/// What changes from step to step.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Scene {
    pub(super) bodies: Bodies,
    pub(super) pairs: Pairs,
    pub(super) ties: Ties,
    pub(super) laws: ForceLaws,
}

/// What a step works with.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Stepper {
    kicks: Kicks,
    listing: Listing,
    pub(super) rows: Vec<Row>,
    pub(super) islands: Islands,
    exact: Exact,
    #[cfg_attr(feature = "save", serde(skip))]
    sweeps: Sweeps,
    pub(super) impacts: Impacts,
    /// Velocities at the start of the step, as far as they are known; that of the background is behind the last.
    pub(super) node: Vec<Motion3>,
    /// Velocities in the middle of the step: first without contacts, then with them.
    middle: Vec<Motion3>,
    free: Vec<Motion3>,
    /// Those without what slows down bodies that are to hit each other at the end of the step.
    smooth: Vec<Motion3>,
    /// Rows of an island that touch.
    touching: Vec<u32>,
    /// Mean velocities over the kick that leads to the middle of the step.
    means: Vec<Motion3>,
    /// Buffer of the projection.
    shifts: Vec<Motion3>,
}

/// Where a step comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum From {
    /// The step before, of the same length.
    Before,
    /// Velocities that are known at its start.
    Start,
}

impl Stepper {
    /// Begins a step of a length `span` [s] at a time. The bodies are at its start, and their motions tell the velocities there.
    pub(super) fn begin(
        &mut self,
        scene: &mut Scene,
        (settings, time, span): (&SteppingSettings, f64, f64),
        from: From,
        books: &mut StepBooks,
    ) -> Result<(), StepError> {
        self.kicks.find(&scene.bodies, &scene.laws, time);
        self.find_free(&scene.bodies, span, from);
        let target_gap = settings.rigid.tolerances.target_gap;
        let lengths = Lengths { span, target_gap, slack: settings.slack };
        let Scene { bodies, pairs, ties, .. } = scene;
        let pairs = settings.rigid.collisions.then_some(pairs);
        self.listing.list(bodies, (pairs, ties), &self.free, lengths, &mut self.rows);
        project(bodies, &mut self.rows, settings.slack, &mut self.shifts, books);
        self.islands.find(bodies, |_| true, &self.rows);
        for row in &self.rows {
            books.note_row(row, target_gap);
        }
        for island in 0..self.islands.count() {
            self.advance_island(scene, (settings, span), from, island, books)?;
        }
        Ok(())
    }

    /// Finds the velocities with which bodies would go through the step without contacts.
    fn find_free(&mut self, bodies: &Bodies, span: f64, from: From) {
        self.node.clear();
        self.node.extend(
            bodies.movings.iter().map(|moving| [moving.velocity.x, moving.velocity.y, moving.angular_velocity]),
        );
        self.node.push([0.0; 3]);
        self.free.clear();
        for (place, nature) in bodies.natures.iter().enumerate() {
            let acceleration = self.kicks.accelerations[place];
            self.free.push(if nature.body.is_fixed() {
                bodies.courses[place].middle
            } else if from == From::Before {
                kicked(&nature.free_motion, bodies.courses[place].middle, acceleration, span)
            } else {
                kicked(&nature.free_motion, self.node[place], acceleration, 0.5 * span)
            });
        }
        self.free.push([0.0; 3]);
        self.middle.clone_from(&self.free);
        self.smooth.resize(self.node.len(), [0.0; 3]);
        self.means.resize(self.node.len(), [0.0; 3]);
    }

    /// Finds the motion of an island through the step.
    fn advance_island(
        &mut self,
        scene: &mut Scene,
        (settings, span): (&SteppingSettings, f64),
        from: From,
        island: usize,
        books: &mut StepBooks,
    ) -> Result<(), StepError> {
        let is_struck = self.strike(scene, (settings, span), from, island, books)?;
        let is_split = is_struck || from == From::Start;
        let kick = if is_split { 0.5 * span } else { span };
        let (members, list) = self.islands.get(island);
        let mut residual = 0.0;
        if !list.is_empty() {
            for &row in list {
                let row = &mut self.rows[row as usize];
                set_offsets(row, span, if list.len() <= LARGEST_EXACT { settings.slack } else { 0.0 });
                let forces = forces_of(scene, row);
                row.set_impulses(forces.map(|force| force * kick));
            }
            books.note_solve();
            residual = settings.residual * largest_kick(&self.rows, list, &self.kicks.accelerations, kick);
            let solving =
                Solving { bodies: &scene.bodies, exact: &mut self.exact, sweeps: &mut self.sweeps, residual };
            solving.solve((&mut self.rows, list), members, &mut self.middle);
        }
        for &body in members {
            self.smooth[body as usize] = self.middle[body as usize];
        }
        if self.find_arrivals(island, (settings, span)) {
            let (members, list) = self.islands.get(island);
            for &body in members {
                self.smooth[body as usize] = self.free[body as usize];
            }
            self.touching.clear();
            self.touching.extend(list.iter().filter(|&&row| self.rows[row as usize].touches));
            let solving =
                Solving { bodies: &scene.bodies, exact: &mut self.exact, sweeps: &mut self.sweeps, residual };
            solving.solve((&mut self.rows, &self.touching), members, &mut self.smooth);
        }
        self.set_off(&mut scene.bodies, island, kick, is_split, books);
        let (_, list) = self.islands.get(island);
        for &row in list {
            remember(scene, &self.rows[row as usize], &self.smooth, kick);
        }
        Ok(())
    }

    /// Resolves the impact at the start of the step, if something in an island has come fast. True if there is one.
    fn strike(
        &mut self,
        scene: &Scene,
        (settings, span): (&SteppingSettings, f64),
        from: From,
        island: usize,
        books: &mut StepBooks,
    ) -> Result<bool, StepError> {
        let (members, list) = self.islands.get(island);
        let Some(slow) = self.slow_speed(list, (settings, span), from) else { return Ok(false) };
        let bodies = &scene.bodies;
        if from == From::Before {
            // The half of a kick that ends here.
            for &body in members {
                let course = &bodies.courses[body as usize];
                let (before, node) = (course.smooth, self.node[body as usize]);
                let mean: Motion3 = std::array::from_fn(|k| 0.5 * (before[k] + node[k]));
                let pushed = course.pushed.map(|acceleration| 0.5 * span * acceleration);
                books.book_body(&bodies.natures[body as usize], mean, pushed, 0.5 * span, false);
                self.means[body as usize] = mean;
            }
            self.book_laws(members, 0.5 * span, false, books);
        }
        let (members, list) = self.islands.get(island);
        let energy = |node: &[Motion3]| -> f64 {
            members.iter().map(|&body| bodies.kinetic_energy(body as usize, node[body as usize])).sum()
        };
        let before = energy(&self.node);
        books.note_kinetic(before);
        let outcome =
            self.impacts.resolve(bodies, (&self.rows, list), &mut self.node, (settings, slow), books.counts().impacts);
        outcome.map_err(|source| StepError { bodies: members.to_vec(), source })?;
        books.book_impact(energy(&self.node) - before);
        for &body in members {
            let nature = &bodies.natures[body as usize];
            let acceleration = self.kicks.accelerations[body as usize];
            let kicked = kicked(&nature.free_motion, self.node[body as usize], acceleration, 0.5 * span);
            (self.middle[body as usize], self.free[body as usize]) = (kicked, kicked);
        }
        Ok(true)
    }

    /// Books what laws do to bodies at the velocities in `means`.
    fn book_laws(&self, members: &[u32], span: f64, is_present: bool, books: &mut StepBooks) {
        let velocity = |body: halfgap_collision::BodyId| {
            members.binary_search(&body.0).is_ok().then(|| self.means[body.index()])
        };
        for (law, power) in self.kicks.powers(velocity) {
            books.book_law(law, power, span, is_present);
        }
    }

    /// Speed [m/s] that is slow in an island in which something has come faster; `None` if nothing has.
    fn slow_speed(&self, list: &[u32], (settings, span): (&SteppingSettings, f64), from: From) -> Option<f64> {
        let mut slow = settings.rigid.tolerances.velocity_tol;
        let mut fastest = 0.0_f64;
        for &row in list {
            let row = &self.rows[row as usize];
            let kick = row.normal.rate(row.places, &self.kicks.accelerations).abs();
            slow = slow.max(SLOW_STEPS * span * kick);
            let rate = || row.normal.rate(row.places, &self.node);
            let closing = match (row.strikes, from) {
                (Some(speed), _) => speed,
                (None, From::Start) if row.is_bilateral => rate().abs(),
                (None, From::Start) if row.touches => -rate(),
                // It has come to touch without being slowed down.
                (None, From::Before) if row.touches && !row.presses && row.rebounds() => -rate(),
                _ => 0.0,
            };
            fastest = fastest.max(closing);
        }
        (fastest > slow).then_some(slow)
    }

    /// Finds contacts of an island that arrive at the end of the step so fast that they rebound. True if there are any.
    fn find_arrivals(&mut self, island: usize, (settings, span): (&SteppingSettings, f64)) -> bool {
        let mut any = false;
        let (_, list) = self.islands.get(island);
        for &index in list {
            let row = &self.rows[index as usize];
            if row.touches || row.normal.impulse <= 0.0 || !row.rebounds() {
                continue;
            }
            let kick = row.normal.rate(row.places, &self.kicks.accelerations);
            let (rate, acceleration) = (row.normal.rate(row.places, &self.node), kick + row.normal.gamma);
            let speed = (rate * rate - 2.0 * acceleration * row.gap).max(0.0).sqrt();
            if speed > settings.rigid.tolerances.velocity_tol.max(SLOW_STEPS * span * kick.abs()) {
                self.rows[index as usize].arrives = Some(speed);
                any = true;
            }
        }
        any
    }

    /// Lets the bodies of an island go through the step with the velocities found.
    fn set_off(&mut self, bodies: &mut Bodies, island: usize, kick: f64, is_split: bool, books: &mut StepBooks) {
        let (members, _) = self.islands.get(island);
        for &body in members {
            let place = body as usize;
            let before = if is_split { self.node[place] } else { bodies.courses[place].middle };
            let (smooth, middle, free) = (self.smooth[place], self.middle[place], self.free[place]);
            let course = &mut bodies.courses[place];
            (course.middle, course.smooth) = (middle, smooth);
            course.acceleration = std::array::from_fn(|k| (smooth[k] - before[k]) / kick);
            course.pushed = std::array::from_fn(|k| (smooth[k] - free[k]) / kick);
            let mean: Motion3 = std::array::from_fn(|k| 0.5 * (smooth[k] + before[k]));
            let pushed = std::array::from_fn(|k| smooth[k] - free[k]);
            books.book_body(&bodies.natures[place], mean, pushed, kick, true);
            self.means[place] = mean;
        }
        let (members, _) = self.islands.get(island);
        self.book_laws(members, kick, true, books);
    }
}

/// An impact that the law cannot resolve, and the bodies of its island.
#[derive(Debug)]
pub(super) struct StepError {
    pub(super) bodies: Vec<u32>,
    pub(super) source: ImpactError,
}

/// Sets what is asked of a row: that its gap is at its target at the end of the step, and that what sticks is where it was.
fn set_offsets(row: &mut Row, span: f64, slack: f64) {
    let line = &mut row.normal;
    // What overlaps more is brought back by the projection, which gives no speed.
    let gap = if row.is_bilateral { row.gap } else { row.gap.max(-slack) };
    line.offset = gap / span + 0.5 * span * line.gamma;
    if let Some(slip) = &mut row.slip {
        let off = if slack > 0.0 { slip.off } else { 0.0 };
        slip.line.offset = off / span + 0.5 * span * slip.line.gamma - slip.running;
    }
}

/// Forces of a row in the last step.
fn forces_of(scene: &Scene, row: &Row) -> [f64; 3] {
    match row.source {
        Source::Contact { pair, contact } => scene.pairs.all()[pair as usize].contacts[contact as usize].forces,
        Source::Connector { connector, direction } => {
            [scene.ties.memory[connector as usize].forces[direction as usize], 0.0, 0.0]
        }
    }
}

/// What solves the problems of an island.
struct Solving<'a> {
    bodies: &'a Bodies,
    exact: &'a mut Exact,
    sweeps: &'a mut Sweeps,
    /// Rate [m/s] that is as good as none.
    residual: f64,
}

impl Solving<'_> {
    /// Finds the impulses of rows, beginning with those that they have, for velocities without them.
    fn solve(self, (rows, list): (&mut [Row], &[u32]), members: &[u32], velocities: &mut [Motion3]) {
        let is_solved =
            list.len() <= LARGEST_EXACT && self.exact.solve(self.bodies, (rows, list), members, velocities);
        if !is_solved {
            self.sweeps.solve(self.bodies, (rows, list), members, velocities, (self.residual, MOST_ROUNDS));
        }
    }
}

/// Largest rate [m/s] at which rows of a list close by one kick.
fn largest_kick(rows: &[Row], list: &[u32], accelerations: &[Motion3], kick: f64) -> f64 {
    let kicks = list.iter().map(|&row| {
        let row = &rows[row as usize];
        row.normal.rate(row.places, accelerations).abs() * kick
    });
    kicks.fold(0.0, f64::max)
}

/// Remembers what a row carries at given velocities, in a step whose kick lasts `kick` [s].
fn remember(scene: &mut Scene, row: &Row, velocities: &[Motion3], kick: f64) {
    let impulses = row.impulses();
    let presses = row.is_bilateral || impulses[0] > 0.0;
    let arrival = row.arrives;
    let forces = if row.touches { impulses.map(|impulse| impulse / kick) } else { [0.0; 3] };
    match row.source {
        Source::Connector { connector, direction } => {
            let tie = &mut scene.ties.memory[connector as usize];
            tie.forces[direction as usize] = forces[0];
            (tie.presses, tie.arrival) = (presses, arrival);
        }
        Source::Contact { pair, contact } => {
            let contact = &mut scene.pairs.all_mut()[pair as usize].contacts[contact as usize];
            (contact.forces, contact.presses, contact.arrival) = (forces, presses, arrival);
            let sticks = presses && row.slip.as_ref().is_some_and(|slip| {
                let stopping = slip.stopping(row.places, velocities);
                !Drag::slips(slip.line.impulse, slip.kinetic * impulses[0], stopping)
            });
            contact.hold = match (sticks, contact.hold) {
                (false, _) => Hold::Slips,
                (true, Hold::Slips) => Hold::Here,
                (true, hold) => hold,
            };
        }
    }
}
