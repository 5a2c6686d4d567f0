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

use crate::rigid::{ContactChanges, ForceLaws, ImpactReport};
use crate::stepping::bodies::{Bodies, Course, Motion3, farthest};
use crate::stepping::books::StepBooks;
use crate::stepping::exact::Exact;
use crate::stepping::impacts::Impacts;
use crate::stepping::islands::Islands;
use crate::stepping::kicks::{Kicks, kicked};
use crate::stepping::listing::Listing;
use crate::stepping::memory::remember;
use crate::stepping::pairs::Pairs;
use crate::stepping::passing::Passing;
use crate::stepping::projection::Shifts;
use crate::stepping::rows::{Lengths, Line, Mover, Rows};
use crate::stepping::settings::SteppingSettings;
use crate::stepping::sleep::Sleep;
use crate::stepping::solving::{Means, solve};
use crate::stepping::sweeps::{Enough, Sweeps};
use crate::stepping::ties::Ties;
use crate::time::Time;

/// Residual beyond which what moves is left to sweeps [-].
const LOOSE: f64 = 1e-3;
/// A contact is slow if it closes no faster than forces make it in so many steps.
pub(super) const SLOW_STEPS: f64 = 2.0;

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
    pub(super) kicks: Kicks,
    listing: Listing,
    /// Contacts, ropes and stops that begin or end to carry a force with the step.
    pub(super) changes: ContactChanges,
    pub(super) rows: Rows,
    /// Speed that forces give in a step, and rate that is as good as none [m/s].
    pub(super) fall: f64,
    pub(super) residual: f64,
    pub(super) islands: Islands,
    exact: Exact,
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) sweeps: Sweeps,
    pub(super) impacts: Impacts,
    /// Velocities at the start of the step, as far as they are known; that of the background is behind the last.
    pub(super) node: Vec<Motion3>,
    /// Velocities at the start of the kick that leads to the middle of the step.
    pub(super) starts: Vec<Motion3>,
    /// Velocities in the middle of the step: first without contacts, then with them.
    pub(super) movers: Vec<Mover>,
    pub(super) free: Vec<Motion3>,
    /// Those without what slows down bodies that are to hit each other at the end of the step.
    pub(super) smooth: Vec<Mover>,
    /// Velocities before an impact, and what its rows asked before it.
    pub(super) before: Vec<Motion3>,
    pub(super) kept: Vec<[Line; 2]>,
    /// Rows of an island that touch, and its resistances against rolling.
    pub(super) touching: Vec<u32>,
    rolling: Vec<u32>,
    /// Mean velocities over the kick that leads to the middle of the step; of fixed bodies those at its start.
    pub(super) means: Vec<Motion3>,
    /// What connectors make of the velocities of bodies.
    pub(super) led: Vec<Mover>,
    /// Something drives, or rubs in a joint.
    pub(super) is_driven: bool,
    #[cfg_attr(feature = "save", serde(skip))]
    shifts: Shifts,
    #[cfg_attr(feature = "save", serde(skip))]
    passing: Passing,
}

/// Where a step comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum From {
    /// The step before, of a length [s].
    Before(f64),
    /// Velocities that are known at its start, at a time [s] after that of the step before.
    Start(f64),
}

impl From {
    /// True if velocities at the start of the step are known.
    pub(super) fn is_start(self) -> bool {
        matches!(self, Self::Start(_))
    }

    /// Time [s] since the start of the step before.
    fn since_last(self) -> f64 {
        let (Self::Before(since) | Self::Start(since)) = self;
        since
    }

    /// Length of the kick [s] that leads to the middle of a step of a length `span` [s].
    fn kick(self, span: f64) -> f64 {
        match self {
            Self::Before(last) => 0.5 * (last + span),
            Self::Start(_) => 0.5 * span,
        }
    }
}

impl Stepper {
    /// Begins a step of a length `span` [s] at a time. The bodies are at its start, and their motions tell the velocities there.
    pub(super) fn begin(
        &mut self,
        scene: &mut Scene,
        (settings, time, span): (&SteppingSettings, f64, f64),
        from: From,
        (books, report): (&mut StepBooks, &mut ImpactReport),
    ) {
        scene.bodies.lead(time, span);
        self.kicks.find(&scene.bodies, &scene.laws, time);
        let fastest = self.kicks.fastest(&scene.bodies);
        self.fall = span * fastest;
        scene.bodies.set_kick(if from.is_start() { span } else { from.kick(span) });
        self.find_free(&scene.bodies, span, from);
        let target_gap = settings.rigid.tolerances.target_gap;
        let lengths = Lengths {
            span,
            time,
            since_last: from.since_last(),
            fall: self.fall,
            target_gap,
            slack: settings.slack,
        };
        let Scene { bodies, pairs, ties, sleep, .. } = scene;
        let pairs = settings.rigid.collisions.then_some(pairs);
        self.listing.list(bodies, (pairs, ties, sleep), &self.free, lengths, &mut self.rows);
        self.changes.clear(Time::from_seconds(time));
        self.changes.end.append(&mut self.listing.ended);
        // What the steps leave open anyway is not worth a shift.
        let slack = settings.slack.max(settings.residual * span * span * fastest);
        let shifts = self.rows.deepest > slack;
        if shifts {
            self.shifts.find(bodies, &mut self.rows.all, slack);
        }
        books.note_gaps(&self.rows, target_gap);
        self.is_driven = self.is_driven(bodies);
        if self.rows.ties {
            self.led.clone_from(&self.movers);
        }
        self.islands.find(bodies, |place| !sleep.is_asleep(place), &self.rows.all);
        self.residual = settings.residual * self.fall;
        for island in 0..self.islands.count() {
            self.advance_island(scene, (settings, span), from, island, (books, report));
        }
        if shifts {
            self.shifts.apply(&mut scene.bodies, &scene.pairs, books);
        }
        if settings.rigid.collisions {
            let Scene { bodies, pairs, ties, .. } = scene;
            self.passing.stop(bodies, (pairs, ties), &settings.rigid.tolerances, (span, self.fall));
        }
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
        self.starts.clone_from(&self.node);
        if !from.is_start() {
            self.starts.iter_mut().zip(&bodies.courses).for_each(|(start, course)| *start = course.smooth);
        }
        for (place, nature) in bodies.natures.iter().enumerate() {
            let acceleration = self.kicks.accelerations[place];
            let Course { middle, smooth, delay, .. } = bodies.courses[place];
            let kick = from.kick(span);
            self.free.push(match from {
                _ if nature.body.is_fixed() => middle,
                From::Before(last) => kicked(&nature.free_motion, smooth, acceleration, kick - delay * last),
                From::Start(_) => kicked(&nature.free_motion, self.node[place], acceleration, kick),
            });
        }
        self.free.push([0.0; 3]);
        self.movers.clear();
        self.movers.extend(self.free.iter().enumerate().map(|(place, &free)| bodies.mover(place, free)));
        // Those of fixed bodies stay; islands write over the others.
        self.smooth.clone_from(&self.movers);
        self.means.clone_from(&self.node);
    }

    /// Finds the motion of an island through the step.
    fn advance_island(
        &mut self,
        scene: &mut Scene,
        (settings, span): (&SteppingSettings, f64),
        from: From,
        island: usize,
        (books, report): (&mut StepBooks, &mut ImpactReport),
    ) {
        let is_struck = self.strike(scene, (settings, span), from, island, (books, report));
        let is_split = is_struck || from.is_start();
        let kick = if is_split { 0.5 * span } else { from.kick(span) };
        let (members, list) = self.islands.get(island);
        let is_loose = settings.residual > LOOSE;
        let is_quiet = members.iter().all(|&body| {
            let place = body as usize;
            farthest(scene.bodies.natures[place].reach, scene.bodies.courses[place].middle) <= self.fall
        });
        let enough = Enough::new(settings.residual, self.fall);
        let means =
            Means { is_start: from.is_start(), is_quiet, is_loose, span, slack: settings.slack, enough };
        if !list.is_empty() {
            let Self { rows, rolling, .. } = self;
            rolling.clear();
            for &row in list {
                let row = &mut rows.all[row as usize];
                rolling.extend(row.roll);
                if kick != span {
                    row.normal.impulse *= kick / span;
                    row.slip.line.impulse *= kick / span;
                    if let Some(apart) = &mut row.apart {
                        apart.most *= kick / span;
                    }
                }
            }
            books.note_solve();
            solve(
                (rows, list, rolling),
                (&mut self.movers, &self.starts, &self.free),
                (&mut self.exact, &mut self.sweeps),
                members,
                means,
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
            solve(
                (rows, touching, rolling),
                (&mut self.smooth, &self.starts, &self.free),
                (&mut self.exact, &mut self.sweeps),
                members,
                means,
            );
        }
        self.set_off(
            &mut scene.bodies,
            island,
            (kick, span),
            (!is_split).then_some(from.since_last()),
            books,
        );
        let (_, list) = self.islands.get(island);
        for &row in list {
            remember(scene, &self.rows, row as usize, (&self.smooth, kick), &mut self.changes);
        }
        let Scene { bodies, laws, sleep, .. } = scene;
        let (members, list) = self.islands.get(island);
        sleep.settle(bodies, laws, (members, &self.rows.all, list), (self.residual, self.fall));
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
            let kick = row.change(&self.kicks.accelerations);
            let (rate, acceleration) = (row.rate(&self.node), kick + row.gamma);
            let speed = (rate * rate - 2.0 * acceleration * row.gap).max(0.0).sqrt();
            if speed > settings.rigid.tolerances.velocity_tol.max(SLOW_STEPS * span * kick.abs()) {
                self.rows.all[index as usize].arrives = Some(speed);
                any = true;
            }
        }
        any
    }
}
