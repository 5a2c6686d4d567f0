//! Contacts with friction one after another, each with the connectors that it reaches.

use super::super::law::ImpactError;
use super::super::patience::Patience;
use super::super::serial::Grouping;
use super::super::shuffle::Shuffle;
use super::motion::{add, rate};
use super::routh::Contact;
use super::{Impact, Rough};

impl Impact {
    /// Solves focus after focus until no row is violated or the patience ends.
    pub(super) fn solve_rough(
        &mut self,
        rough: &mut Rough,
        grouping: Grouping,
        mut shuffle: Option<&mut Shuffle>,
        patience: &mut Patience,
    ) -> Result<(), ImpactError> {
        while let Some(focus) = self.focus(shuffle.as_deref_mut(), patience.small()) {
            let set = self.join_focus(focus, grouping, patience.small());
            let contacts = set.iter().filter(|&&row| !self.rows[row].is_bilateral()).count();
            match (contacts, &set[..]) {
                (0, [row]) => self.stop_alone(rough, *row),
                (1, _) if !self.rows[focus].is_bilateral() => self.strike(rough, focus, &set)?,
                (0, _) => self.stop_rough(rough, &set)?,
                _ => self.rebound_rough(rough, &set)?,
            }
            let count = set.len();
            self.scratch.set = set;
            if !patience.spend(count) {
                break;
            }
        }
        Ok(())
    }

    /// Brings a connector's row to the rate of its elasticity, alone.
    fn stop_alone(&mut self, rough: &mut Rough, row: usize) {
        let impulse = (self.rebound_alone(row) - self.rates[row]) / self.couplings.diagonal(row);
        self.solves += 1;
        self.impulses[row] += impulse;
        rough.push(&self.rows, row, [impulse, 0.0]);
        self.renew_rates(rough);
    }

    /// Takes the path of the impulse of one contact, through the bilateral rows of `set`.
    fn strike(&mut self, rough: &mut Rough, row: usize, set: &[usize]) -> Result<(), ImpactError> {
        let tied: Vec<usize> = set.iter().copied().filter(|&other| other != row).collect();
        let data = self.rows[row];
        let friction = rough.rows[row];
        let (normal, normal_ties) = self.response_through(rough, row, &data.response, &tied)?;
        let along = match friction {
            Some(friction) => Some(self.response_through(rough, row, &friction.response, &tied)?),
            None => None,
        };
        let sides = rough.motions.sides(row);
        let mut coupling = [rate(sides, &data.jacobian, &normal), 0.0, 0.0];
        if let (Some(friction), Some((tangential, _))) = (&friction, &along) {
            coupling[1] = rate(sides, &friction.jacobian, &normal);
            coupling[2] = rate(sides, &friction.jacobian, tangential);
        }
        // A contact that connectors hold cannot be opened alone; the last pass tells.
        if coupling[0] <= 0.0 {
            return self.stop_rough(rough, set);
        }
        let closing = -self.rates[row];
        let blow = Contact {
            coupling,
            rates: [-closing, rough.slips[row]],
            friction: friction.map_or(0.0, |friction| friction.coefficient),
            elasticity: if data.rebounds_at(closing) { data.elasticity } else { 0.0 },
            tangential_elasticity: friction.map_or(0.0, |friction| friction.tangential_elasticity),
            restitution: self.restitution,
        }
        .resolve();
        self.solves += 1;
        self.impulses[row] += blow.normal;
        rough.impulses[row] += blow.tangential;
        rough.loss += blow.friction_loss;
        let mut pull = |responses: &[[f64; 3]], ties: &[f64], impulse: f64| {
            for (sum, change) in rough.motions.changes().iter_mut().zip(responses) {
                (0..3).for_each(|k| sum[k] += impulse * change[k]);
            }
            tied.iter().zip(ties).for_each(|(&other, tie)| self.impulses[other] += impulse * tie);
        };
        pull(&normal, &normal_ties, blow.normal);
        if let Some((tangential, ties)) = &along {
            pull(tangential, ties, blow.tangential);
        }
        self.renew_rates(rough);
        Ok(())
    }

    /// Changes of the velocities of all bodies by a unit impulse along a response, while bilateral rows stay at rest, and
    /// the impulses of these.
    fn response_through(
        &mut self,
        rough: &mut Rough,
        row: usize,
        response: &[f64; 6],
        tied: &[usize],
    ) -> Result<(Vec<[f64; 3]>, Vec<f64>), ImpactError> {
        let mut change = vec![[0.0; 3]; rough.motions.inertia().len()];
        add(rough.motions.sides(row), response, 1.0, &mut change);
        if tied.is_empty() {
            return Ok((change, Vec::new()));
        }
        rough.begin_problem();
        for &other in tied {
            let offset = rough.motions.rate_by(other, &self.rows[other], &change);
            rough.list(&self.rows, other, offset);
        }
        rough.solve(self.rows.len(), None)?;
        self.solves += 1;
        let impulses: Vec<f64> = rough.solution.force.clone();
        for (&other, &impulse) in tied.iter().zip(&impulses) {
            rough.motions.push(other, &self.rows[other], impulse, &mut change);
        }
        Ok((change, impulses))
    }

    /// Brings the rates of all rows up to date with the motion of the bodies.
    pub(super) fn renew_rates(&mut self, rough: &mut Rough) {
        for (row, data) in self.rows.iter().enumerate() {
            let change = rough.motions.rate_of(row, data);
            self.rates[row] = data.rate + change;
            self.largest_change = self.largest_change.max(change.abs());
            if let Some(friction) = &rough.rows[row] {
                rough.slips[row] = friction.rate + rough.motions.rate(row, &friction.jacobian);
            }
        }
        self.noise = self.noise.max(super::super::NOISE * self.largest_change);
    }
}
