//! Impacts at the start of a step: when there is one, and what sets out after it.

use crate::rigid::ImpactReport;
use crate::stepping::balance::Balance;
use crate::stepping::bodies::{Bodies, Motion3};
use crate::stepping::books::{Driven, StepBooks};
use crate::stepping::kicks::kicked;
use crate::stepping::report;
use crate::stepping::rows::Row;
use crate::stepping::settings::SteppingSettings;
use crate::stepping::solving::LARGEST_SMALL;
use crate::stepping::step::{From, SLOW_STEPS, Scene, Stepper};
use crate::stepping::sweeps::{Enough, Problem};
use halfgap_collision::BodyId;

impl Stepper {
    /// Resolves the impact at the start of the step, if something in an island has come fast. True if there is one.
    pub(super) fn strike(
        &mut self,
        scene: &Scene,
        (settings, span): (&SteppingSettings, f64),
        from: From,
        island: usize,
        (books, report): (&mut StepBooks, &mut ImpactReport),
    ) -> bool {
        if !from.is_start() && !self.rows.strikes {
            return false;
        }
        let (members, list) = self.islands.get(island);
        let Some(slow) = self.slow_speed(list, (settings, span), from) else { return false };
        let bodies = &scene.bodies;
        if let From::Before(last) = from {
            // The half of a kick that ends here.
            for &body in members {
                let course = &bodies.courses[body as usize];
                let (before, node) = (course.smooth, self.node[body as usize]);
                let mean: Motion3 = std::array::from_fn(|k| 0.5 * (before[k] + node[k]));
                let pushed = course.pushed.map(|acceleration| 0.5 * last * acceleration);
                books.book_body((bodies, body as usize), mean, pushed, 0.5 * last, false);
                self.means[body as usize] = mean;
            }
            self.book_laws(members, 0.5 * last, false, books);
            // Rows begin with the forces of the last step.
            self.book_driven(bodies, (island, 0.5 * last / span), (0.5 * last, false), books);
        }
        let (members, list) = self.islands.get(island);
        let before = energy(bodies, members, &self.node);
        books.note_kinetic(before);
        self.before.clone_from(&self.node);
        let is_resolved = list.len() <= LARGEST_SMALL
            && self
                .impacts
                .resolve(
                    bodies,
                    (&mut self.rows.all, list),
                    &mut self.node,
                    (settings, slow),
                    books.counts().impacts,
                )
                .is_ok()
            && !self.balance(bodies, island).explodes(before);
        if !is_resolved {
            let (members, _) = self.islands.get(island);
            members.iter().for_each(|&body| self.node[body as usize] = self.before[body as usize]);
            // What the law has no answer for, such as rows that contradict each other, is as good as too large for it.
            self.strike_many(bodies, island, slow, settings.residual);
        }
        let (members, list) = self.islands.get(island);
        books.book_impact(energy(bodies, members, &self.node) - before);
        let rows = list.iter().map(|&row| &self.rows.all[row as usize]).filter(|row| row.strikes.is_some());
        report::add_rows((scene, settings), rows, (&self.before, &self.node), report);
        report.energy_change += energy(bodies, members, &self.node) - before;
        let states = members
            .iter()
            .map(|&body| (BodyId(body), bodies.state_with(body as usize, self.node[body as usize])));
        report.add_states(states);
        for &body in members {
            let nature = &bodies.natures[body as usize];
            let acceleration = self.kicks.accelerations[body as usize];
            let kicked = kicked(&nature.free_motion, self.node[body as usize], acceleration, 0.5 * span);
            self.starts[body as usize] = self.node[body as usize];
            (self.movers[body as usize].velocity, self.free[body as usize]) = (kicked, kicked);
        }
        true
    }

    /// What the blows of an island did.
    fn balance(&self, bodies: &Bodies, island: usize) -> Balance {
        let mut balance = Balance::default();
        let mut driven = Driven::default();
        let (_, list) = self.islands.get(island);
        for &row in list {
            let row = &self.rows.all[row as usize];
            let closing = row.rate(&self.before) + row.rate(&self.node);
            let slipping = row.slip_rate(&self.before) + row.slip_rate(&self.node);
            row.weigh(row.blows, [closing, slipping], &mut balance);
            if self.is_driven {
                row.drive_blow(row.blows, bodies, [&self.before, &self.node], &mut driven);
            }
        }
        balance.give(driven.drives);
        balance
    }

    /// Resolves an impact of many rows at once by sweeps: each that has come faster than `slow` opens by its elasticity (Newton's law),
    /// or all just stop if that would give energy.
    fn strike_many(&mut self, bodies: &Bodies, island: usize, slow: f64, share: f64) {
        let enough = Enough::new(share, self.fall);
        let (members, list) = self.islands.get(island);
        let Self { rows, touching, kept, smooth, movers, before, node, sweeps, is_driven, .. } = self;
        touching.clear();
        touching.extend(list.iter().filter(|&&row| {
            let row = &rows.all[row as usize];
            row.touches && !row.pulls()
        }));
        kept.clear();
        for &row in touching.iter() {
            let row = &mut rows.all[row as usize];
            let rate = row.striking_rate(node);
            let rebounds = if rate < -slow { row.elasticity * rate } else { 0.0 };
            kept.push([row.normal, row.slip.line]);
            (row.normal.offset, row.normal.impulse) = (rebounds + row.prescribed.unwrap_or(0.0), 0.0);
            (row.slip.line.offset, row.slip.line.impulse) = (-row.slip.running, 0.0);
        }
        let energy_before = energy(bodies, members, before);
        // Bodies that are moved have another velocity in the middle of the step.
        let places = |rows: &[Row], row: u32| rows[row as usize].all_ends();
        for place in touching.iter().flat_map(|&row| places(&rows.all, row)) {
            smooth[place].velocity = before[place];
        }
        for is_elastic in [true, false] {
            for &body in members {
                smooth[body as usize].velocity = before[body as usize];
            }
            if !is_elastic {
                for &row in touching.iter() {
                    let row = &mut rows.all[row as usize];
                    row.normal.offset = row.prescribed.unwrap_or(0.0);
                }
            }
            let (list, rolls) = (touching.as_slice(), &mut rows.rolls);
            let mut problem =
                Problem { rows: &mut rows.all, list, rolls, rolling: &[], movers: smooth, before };
            sweeps.solve(&mut problem, members, enough);
            for &body in members {
                node[body as usize] = smooth[body as usize].velocity;
            }
            let mut driven = Driven::default();
            for row in touching.iter().map(|&row| &rows.all[row as usize]).filter(|_| *is_driven) {
                let blows = [row.normal.impulse, row.slip.line.impulse];
                row.drive_blow(blows, bodies, [before, node], &mut driven);
            }
            if energy(bodies, members, node) - driven.drives <= energy_before {
                break;
            }
        }
        for place in touching.iter().flat_map(|&row| places(&rows.all, row)) {
            smooth[place].velocity = movers[place].velocity;
        }
        for (&row, [normal, slip]) in touching.iter().zip(kept.iter()) {
            let row = &mut rows.all[row as usize];
            row.blows = [row.normal.impulse, row.slip.line.impulse];
            (row.normal, row.slip.line) = (*normal, *slip);
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
            slow = slow.max(SLOW_STEPS * span * row.change(&self.kicks.accelerations).abs());
            let closing = match (row.strikes, from) {
                (Some(speed), _) => speed,
                (None, From::Start(_)) if row.is_bilateral => row.rate(&self.node).abs(),
                (None, From::Start(_)) if row.touches && !row.pulls() => -row.rate(&self.node),
                _ => 0.0,
            };
            fastest = fastest.max(closing);
        }
        (fastest > slow).then_some(slow)
    }
}

/// Kinetic energy [J] of some bodies.
fn energy(bodies: &Bodies, members: &[u32], velocities: &[Motion3]) -> f64 {
    members.iter().map(|&body| bodies.kinetic_energy(body as usize, velocities[body as usize])).sum()
}
