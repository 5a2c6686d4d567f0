//! Rest: an island whose bodies have not moved for some steps sleeps until something touches it.
//!
//! *Invariant*: a body that sleeps does not move, and nothing that is awake presses on it.

use crate::rigid::ForceLaws;
use crate::stepping::bodies::{Bodies, farthest};
use crate::stepping::pairs::Pairs;
use crate::stepping::rows::Row;
use crate::stepping::ties::Ties;
use halfgap_collision::BodyId;

/// Number of steps in which bodies must not have moved: a body that is thrown up is slow for one.
const STEPS: u32 = 8;
/// Speed at which a body rests, as a multiple of the residual of a step [-], and at most as a fraction of the speed that forces give
/// it in one [-]: what falls is faster after two.
const RESTING: f64 = 10.0;
const FALLING: f64 = 0.5;

/// Which bodies sleep.
#[derive(Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Sleep {
    /// Number of steps for which each body has rested.
    rested: Vec<u32>,
    asleep: Vec<bool>,
    /// Buffer: bodies that have been woken, and whose neighbours have yet to be.
    woken: Vec<u32>,
}

impl Clone for Sleep {
    fn clone(&self) -> Self {
        let mut sleep = Self::default();
        sleep.clone_from(self);
        sleep
    }

    /// Uses the buffers again.
    fn clone_from(&mut self, source: &Self) {
        let Self { rested, asleep, woken: _ } = source;
        self.rested.clone_from(rested);
        self.asleep.clone_from(asleep);
    }
}

impl Sleep {
    pub(super) fn new(count: usize) -> Self {
        Self { rested: vec![0; count], asleep: vec![false; count], woken: Vec::new() }
    }

    #[inline]
    pub(super) fn is_asleep(&self, place: usize) -> bool {
        self.asleep[place]
    }

    /// Wakes all.
    pub(super) fn wake_all(&mut self) {
        self.asleep.fill(false);
        self.rested.fill(0);
    }

    /// Wakes a body, and all that rest on each other with it. False if it was awake.
    pub(super) fn wake(&mut self, bodies: &Bodies, (pairs, ties): (&Pairs, &Ties), body: usize) -> bool {
        if !self.asleep[body] {
            return false;
        }
        let mut woken = std::mem::take(&mut self.woken);
        self.rouse(body, &mut woken);
        while let Some(next) = woken.pop() {
            let next = BodyId(next);
            for &pair in pairs.of(next) {
                let pair = &pairs.all()[pair as usize];
                if pair.contacts.iter().any(|contact| contact.presses) {
                    let [a, b] = pair.bodies;
                    self.rouse(if a == next { b.index() } else { a.index() }, &mut woken);
                }
            }
            for connector in ties.all.iter().filter(|connector| connector.all_bodies().any(|one| one == next))
            {
                for other in connector.all_bodies().filter(|&other| !bodies.is_fixed(other)) {
                    self.rouse(other.index(), &mut woken);
                }
            }
        }
        self.woken = woken;
        true
    }

    fn rouse(&mut self, body: usize, woken: &mut Vec<u32>) {
        if self.asleep[body] {
            (self.asleep[body], self.rested[body]) = (false, 0);
            woken.push(body as u32);
        }
    }

    /// Lets an island sleep if all its bodies have rested for some steps, whose residual was `residual` [m/s] and in which
    /// forces make nothing faster than by `fall` [m/s], and nothing drives it:
    /// no force law, and no surface or fixed body that moves.
    pub(super) fn settle(
        &mut self,
        bodies: &mut Bodies,
        laws: &ForceLaws,
        (members, rows, list): (&[u32], &[Row], &[u32]),
        (residual, fall): (f64, f64),
    ) {
        let resting = (RESTING * residual).min(FALLING * fall);
        let mut rested = u32::MAX;
        for &member in members {
            let place = member as usize;
            let rests = farthest(bodies.natures[place].reach, bodies.courses[place].middle) <= resting
                && laws.of(BodyId(member)).is_empty();
            self.rested[place] = if rests { self.rested[place] + 1 } else { 0 };
            rested = rested.min(self.rested[place]);
        }
        if rested < STEPS {
            return;
        }
        let drives = |row: &Row| {
            row.slip.running != 0.0
                || row.prescribed.is_some()
                || row.all_ends().any(|place| {
                    place < bodies.count()
                        && bodies.natures[place].body.is_fixed()
                        && bodies.courses[place].middle != [0.0; 3]
                })
        };
        if list.iter().map(|&row| &rows[row as usize]).any(drives) {
            return;
        }
        for &member in members {
            self.asleep[member as usize] = true;
            bodies.courses[member as usize].stop();
        }
    }
}
