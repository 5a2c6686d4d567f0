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
use crate::stepping::bodies::{Bodies, Motion3, farthest};
use crate::stepping::books::StepBooks;
use crate::stepping::contacts::Hold;
use crate::stepping::exact::{Effort, Exact};
use crate::stepping::impacts::Impacts;
use crate::stepping::islands::Islands;
use crate::stepping::kicks::{Kicks, kicked};
use crate::stepping::listing::{Lengths, Listing};
use crate::stepping::pairs::Pairs;
use crate::stepping::projection::project;
use crate::stepping::rows::{Line, Mover, Rows, Source};
use crate::stepping::settings::SteppingSettings;
use crate::stepping::sleep::Sleep;
use crate::stepping::sweeps::Problem;
use crate::stepping::ties::Ties;
use halfgap_contact::ImpactError;

/// Largest number of rounds of sweeps; what they leave is corrected in the steps that follow.
const MOST_ROUNDS: u32 = 100;
/// Number of rows up to which an island is solved exactly, by whatever it takes.
const LARGEST_SMALL: usize = 60;
/// Number of rows up to which an island in which nothing is faster than forces make it in a step is solved exactly, if the forces of the
/// last step tell its modes: a tower stands, where sweeps would let each of its contacts close a little.
const LARGEST_QUIET: usize = 1000;
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
    pub(super) sleep: Sleep,
}

/// What a step works with.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Stepper {
    kicks: Kicks,
    listing: Listing,
    pub(super) rows: Rows,
    /// Speed that forces give in a step, and rate that is as good as none [m/s].
    fall: f64,
    residual: f64,
    pub(super) islands: Islands,
    exact: Exact,
    pub(super) impacts: Impacts,
    /// Velocities at the start of the step, as far as they are known; that of the background is behind the last.
    pub(super) node: Vec<Motion3>,
    /// Velocities in the middle of the step: first without contacts, then with them.
    movers: Vec<Mover>,
    free: Vec<Motion3>,
    /// Those without what slows down bodies that are to hit each other at the end of the step.
    smooth: Vec<Mover>,
    /// Rows of an island that touch, and its resistances against rolling.
    touching: Vec<u32>,
    rolling: Vec<u32>,
    /// Mean velocities over the kick that leads to the middle of the step.
    means: Vec<Motion3>,
    /// Buffer of the projection.
    shifts: Vec<Mover>,
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
        let Scene { bodies, pairs, ties, sleep, .. } = scene;
        let pairs = settings.rigid.collisions.then_some(pairs);
        self.listing.list(bodies, (pairs, ties, sleep), &self.free, lengths, &mut self.rows);
        if self.rows.deepest > settings.slack || self.rows.farthest_off > settings.slack {
            project(bodies, &mut self.rows.all, settings.slack, &mut self.shifts, books);
        }
        books.note_gaps(&self.rows, target_gap);
        self.islands.find(bodies, |place| !sleep.is_asleep(place), &self.rows.all);
        self.fall = span * self.kicks.fastest();
        self.residual = settings.residual * self.fall;
        for island in 0..self.islands.count() {
            self.advance_island(scene, (settings, span), from, island, books)?;
        }
        Ok(())
    }

    /// Finds the velocities with which bodies would go through the step without contacts.
    fn find_free(&mut self, bodies: &Bodies, span: f64, from: From) {
        self.node.clear();
        self.node.extend(
            bodies
                .movings
                .iter()
                .map(|moving| [moving.velocity.x, moving.velocity.y, moving.angular_velocity]),
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
        self.movers.clear();
        self.movers.extend(self.free.iter().enumerate().map(|(place, &free)| bodies.mover(place, free)));
        if self.smooth.len() != self.movers.len() {
            self.smooth.clone_from(&self.movers);
        }
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
        let is_quiet = members.iter().all(|&body| {
            let place = body as usize;
            farthest(scene.bodies.natures[place].reach, scene.bodies.courses[place].middle) <= self.fall
        });
        if !list.is_empty() {
            let Self { rows, rolling, .. } = self;
            rolling.clear();
            for &row in list {
                let row = &mut rows.all[row as usize];
                rolling.extend(row.roll);
                if is_split {
                    row.normal.impulse *= 0.5;
                    row.slip.line.impulse *= 0.5;
                }
            }
            books.note_solve();
            let mut problem = Problem {
                rows: &mut rows.all,
                list,
                rolls: &mut rows.rolls,
                rolling,
                movers: &mut self.movers,
            };
            solve(
                &mut problem,
                &mut self.exact,
                members,
                (from, is_quiet),
                (span, settings.slack),
                self.residual,
            );
        }
        for &body in members {
            self.smooth[body as usize].velocity = self.movers[body as usize].velocity;
        }
        if self.rows.rebounds && self.find_arrivals(island, (settings, span)) {
            let (members, list) = self.islands.get(island);
            for &body in members {
                self.smooth[body as usize].velocity = self.free[body as usize];
            }
            let Self { rows, rolling, touching, .. } = self;
            touching.clear();
            touching.extend(list.iter().filter(|&&row| rows.all[row as usize].touches));
            rolling.retain(|&roll| rows.all[rows.rolls[roll as usize].row as usize].touches);
            let mut problem = Problem {
                rows: &mut rows.all,
                list: touching,
                rolls: &mut rows.rolls,
                rolling,
                movers: &mut self.smooth,
            };
            solve(
                &mut problem,
                &mut self.exact,
                members,
                (from, is_quiet),
                (span, settings.slack),
                self.residual,
            );
        }
        self.set_off(&mut scene.bodies, island, kick, is_split, books);
        let (_, list) = self.islands.get(island);
        for &row in list {
            remember(scene, &self.rows, row as usize, &self.smooth, kick);
        }
        let Scene { bodies, laws, sleep, .. } = scene;
        let (members, list) = self.islands.get(island);
        sleep.settle(bodies, laws, (members, &self.rows.all, list), (self.residual, self.fall));
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
        if from == From::Before && !self.rows.strikes {
            return Ok(false);
        }
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
                books.book_body((bodies, body as usize), mean, pushed, 0.5 * span, false);
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
        let outcome = self.impacts.resolve(
            bodies,
            (&self.rows.all, list),
            &mut self.node,
            (settings, slow),
            books.counts().impacts,
        );
        outcome.map_err(|source| StepError { bodies: members.to_vec(), source })?;
        books.book_impact(energy(&self.node) - before);
        for &body in members {
            let nature = &bodies.natures[body as usize];
            let acceleration = self.kicks.accelerations[body as usize];
            let kicked = kicked(&nature.free_motion, self.node[body as usize], acceleration, 0.5 * span);
            (self.movers[body as usize].velocity, self.free[body as usize]) = (kicked, kicked);
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
    fn slow_speed(
        &self,
        list: &[u32],
        (settings, span): (&SteppingSettings, f64),
        from: From,
    ) -> Option<f64> {
        let mut slow = settings.rigid.tolerances.velocity_tol;
        let mut fastest = 0.0_f64;
        for &row in list {
            let row = &self.rows.all[row as usize];
            slow = slow.max(SLOW_STEPS * span * row.rate(&self.kicks.accelerations).abs());
            let closing = match (row.strikes, from) {
                (Some(speed), _) => speed,
                (None, From::Start) if row.is_bilateral => row.rate(&self.node).abs(),
                (None, From::Start) if row.touches => -row.rate(&self.node),
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
            let row = &self.rows.all[index as usize];
            if row.touches || row.normal.impulse <= 0.0 || !row.rebounds() {
                continue;
            }
            let kick = row.rate(&self.kicks.accelerations);
            let (rate, acceleration) = (row.rate(&self.node), kick + row.gamma);
            let speed = (rate * rate - 2.0 * acceleration * row.gap).max(0.0).sqrt();
            if speed > settings.rigid.tolerances.velocity_tol.max(SLOW_STEPS * span * kick.abs()) {
                self.rows.all[index as usize].arrives = Some(speed);
                any = true;
            }
        }
        any
    }

    /// Lets the bodies of an island go through the step with the velocities found.
    fn set_off(
        &mut self,
        bodies: &mut Bodies,
        island: usize,
        kick: f64,
        is_split: bool,
        books: &mut StepBooks,
    ) {
        let (members, _) = self.islands.get(island);
        for &body in members {
            let place = body as usize;
            let before = if is_split { self.node[place] } else { bodies.courses[place].middle };
            let (smooth, middle) = (self.smooth[place].velocity, self.movers[place].velocity);
            let free = self.free[place];
            let course = &mut bodies.courses[place];
            (course.middle, course.smooth) = (middle, smooth);
            course.acceleration = std::array::from_fn(|k| (smooth[k] - before[k]) / kick);
            course.pushed = std::array::from_fn(|k| (smooth[k] - free[k]) / kick);
            let mean: Motion3 = std::array::from_fn(|k| 0.5 * (smooth[k] + before[k]));
            let pushed = std::array::from_fn(|k| smooth[k] - free[k]);
            books.book_body((bodies, place), mean, pushed, kick, true);
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

/// Finds the impulses of the rows of an island, beginning with those that they have, for velocities without them.
fn solve(
    problem: &mut Problem<'_>,
    exact: &mut Exact,
    members: &[u32],
    (from, is_quiet): (From, bool),
    (span, slack): (f64, f64),
    residual: f64,
) {
    let effort = match problem.list.len() {
        0..=LARGEST_SMALL => Some(Effort::Full),
        // Without forces to begin with.
        0..=LARGEST_QUIET if from == From::Start => Some(Effort::Full),
        0..=LARGEST_QUIET if is_quiet => Some(Effort::Near),
        _ => None,
    };
    let is_solved = effort.is_some_and(|effort| exact.solve(problem, members, (span, slack), effort));
    if !is_solved {
        problem.sweep(residual, MOST_ROUNDS);
    }
}

/// Remembers what a row carries at given velocities, in a step whose kick lasts `kick` [s].
fn remember(scene: &mut Scene, rows: &Rows, index: usize, movers: &[Mover], kick: f64) {
    let row = &rows.all[index];
    let [normal, slip] = [&row.normal, &row.slip.line].map(|line| line.impulse);
    let presses = row.is_bilateral || normal > 0.0;
    let share = if row.touches { 1.0 / kick } else { 0.0 };
    match row.source {
        Source::Connector { connector, direction } => {
            let tie = &mut scene.ties.memory[connector as usize];
            tie.forces[direction as usize] = share * normal;
            (tie.presses, tie.arrival) = (presses, row.arrives);
        }
        Source::Contact { pair, contact } => {
            let contact = &mut scene.pairs.all_mut()[pair as usize].contacts[contact as usize];
            let roll = row.roll.map_or(0.0, |roll| rows.rolls[roll as usize].line.impulse);
            contact.forces = [normal, slip, roll].map(|impulse| share * impulse);
            (contact.presses, contact.arrival) = (presses, row.arrives);
            let sticks = presses && row.slip.line.is_some() && {
                let [p, q] = row.ends().map(|place| &movers[place]);
                let stopping = slip - row.slip.line.wanted(p, q);
                !Line::slips(slip, row.slip.bounds[1] * normal, stopping)
            };
            contact.hold = match (sticks, contact.hold) {
                (false, _) => Hold::Slips,
                (true, Hold::Slips) => Hold::Here,
                (true, hold) => hold,
            };
        }
    }
}
