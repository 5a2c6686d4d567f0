//! How bodies set out from the start of a step, and what is booked of the kick that led to its middle.

use crate::stepping::bodies::{Bodies, Motion3, farthest};
use crate::stepping::books::StepBooks;
use crate::stepping::step::Stepper;
use halfgap_collision::BodyId;

/// A body is struck at the start of a step if contacts push it by more than in the step before, and by more than this share of what
/// forces make in a step, and of what connectors made of its velocity in both [-]: the mean of the velocities before and after is then none
/// that it ever has.
const JUMP: f64 = 0.2;

impl Stepper {
    /// Books what laws do to bodies at the velocities in `means`.
    pub(super) fn book_laws(&self, members: &[u32], span: f64, is_present: bool, books: &mut StepBooks) {
        let velocity =
            |body: BodyId| members.binary_search(&body.0).is_ok().then(|| self.means[body.index()]);
        for (law, power) in self.kicks.powers(velocity) {
            books.book_law(law, power, span, is_present);
        }
    }

    /// Lets the bodies of an island go through the step with the velocities found, after a step of a length `last_span` [s], or from
    /// velocities that are known at its start.
    pub(super) fn set_off(
        &mut self,
        bodies: &mut Bodies,
        island: usize,
        (kick, span): (f64, f64),
        last_span: Option<f64>,
        books: &mut StepBooks,
    ) {
        self.lead(island);
        let (members, _) = self.islands.get(island);
        for &body in members {
            let place = body as usize;
            let before = if last_span.is_none() { self.node[place] } else { bodies.courses[place].smooth };
            let (smooth, middle) = (self.smooth[place].velocity, self.movers[place].velocity);
            let free = self.free[place];
            let last = bodies.courses[place];
            let course = &mut bodies.courses[place];
            (course.middle, course.smooth, course.delay) = (middle, smooth, 0.0);
            let pushed: Motion3 = std::array::from_fn(|k| smooth[k] - free[k]);
            course.push = pushed.map(|change| span / kick * change);
            course.jump = last_span.map_or(0.0, |last_span| {
                let jump = |k: usize| course.push[k] - span / last_span * last.push[k];
                farthest(bodies.natures[place].reach, std::array::from_fn(jump))
            });
            let led = if self.rows.ties { self.led[place].velocity } else { [0.0; 3] };
            course.led = span / kick * farthest(bodies.natures[place].reach, led);
            let is_struck = course.jump > JUMP * self.fall.max(course.led.min(last.led));
            if let Some(last_span) = last_span
                && (is_struck || last.delay > 0.0)
            {
                // It has been struck at the start of the step, or has its own time: part of a kick led there, and half a one leads on, or as
                // much of it as it is not held against.
                let acceleration = self.kicks.accelerations[place];
                let kick: Motion3 = acceleration.map(|acceleration| 0.5 * span * acceleration);
                let since_mean = std::array::from_fn(|k| 0.5 * (smooth[k] - before[k]));
                let share = share_along(kick, since_mean);
                let after = std::array::from_fn(|k| smooth[k] - share * kick[k]);
                course.acceleration = acceleration.map(|acceleration| share * acceleration);
                course.pushed = acceleration.map(|acceleration| (share - 1.0) * acceleration);
                let node = self.node[place];
                let until = std::array::from_fn(|k| 0.5 * (before[k] + node[k]));
                let late = (0.5 - last.delay) * last_span;
                let pushed = last.pushed.map(|acceleration| late * acceleration);
                books.book_body((bodies, place), until, pushed, late, false);
                books.book_blow(bodies.kinetic_energy(place, after) - bodies.kinetic_energy(place, node));
                let since: Motion3 = std::array::from_fn(|k| 0.5 * (after[k] + smooth[k]));
                let held = kick.map(|kick| (share - 1.0) * kick);
                books.book_body((bodies, place), since, held, 0.5 * span, true);
                self.means[place] = std::array::from_fn(|k| 0.5 * (until[k] + since[k]));
                continue;
            }
            course.acceleration = std::array::from_fn(|k| (smooth[k] - before[k]) / kick);
            course.pushed = pushed.map(|change| change / kick);
            let mean: Motion3 = std::array::from_fn(|k| 0.5 * (smooth[k] + before[k]));
            books.book_body((bodies, place), mean, pushed, kick, true);
            self.means[place] = mean;
        }
        let (members, _) = self.islands.get(island);
        self.book_laws(members, kick, true, books);
        self.book_driven(bodies, (island, 1.0), (kick, true), books);
    }

    /// Finds what connectors make of the velocities of an island, if there are any.
    fn lead(&mut self, island: usize) {
        let Self { islands, rows, led, .. } = self;
        if !rows.ties {
            return;
        }
        let (members, list) = islands.get(island);
        for &body in members {
            led[body as usize].velocity = [0.0; 3];
        }
        for row in list.iter().map(|&row| &rows.all[row as usize]).filter(|row| row.is_tie()) {
            row.push(led, row.normal.impulse);
        }
    }
}

/// Share of a motion, from none to all of it, that comes nearest to another one.
fn share_along(motion: Motion3, other: Motion3) -> f64 {
    let product = |p: Motion3, q: Motion3| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let square = product(motion, motion);
    if square > 0.0 { (product(motion, other) / square).clamp(0.0, 1.0) } else { 0.0 }
}
