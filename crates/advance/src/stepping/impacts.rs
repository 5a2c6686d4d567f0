//! Impacts at the start of a step: contacts that have come fast, with all that touches them, by the impact law.

use crate::stepping::apart::Third;
use crate::stepping::bodies::{Bodies, Motion3};
use crate::stepping::rows::{Mover, Row};
use crate::stepping::settings::SteppingSettings;
use halfgap_collision::BodyId;
use halfgap_contact::{
    CollisionRow, CollisionThird, FrictionRow, Impact, ImpactError, InverseInertia, RowKind,
};

/// The impact law with its buffers.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Impacts {
    impact: Impact,
    /// The rows of the impact.
    listed: Vec<u32>,
}

impl Impacts {
    /// Changes the velocities of an island, in which something closes faster than `slow`, by the impact law.
    pub(super) fn resolve(
        &mut self,
        bodies: &Bodies,
        (rows, list): (&mut [Row], &[u32]),
        velocities: &mut [Motion3],
        (settings, slow): (&SteppingSettings, f64),
        index: u64,
    ) -> Result<(), ImpactError> {
        self.listed.clear();
        let takes_part = |&&row: &&u32| {
            let row = &rows[row as usize];
            row.is_bilateral || row.touches && !row.pulls() && row.striking_rate(velocities) <= slow
        };
        self.listed.extend(list.iter().filter(takes_part));
        let made = self.listed.iter().map(|&row| {
            let row = &rows[row as usize];
            let ids = row.bodies(bodies.count());
            let inertia = ids.map(|body| bodies.inertia(body));
            let kind = if row.is_bilateral { RowKind::Bilateral } else { RowKind::Unilateral };
            let rate = row.striking_rate(velocities);
            let third = row.third().map(|Third { place, arm }| {
                let body = BodyId(place);
                CollisionThird::new(body, arm, bodies.inertia(body))
            });
            CollisionRow {
                third,
                elasticity: row.elasticity,
                velocity_tol: slow,
                kind,
                was_active: row.strikes.is_none(),
                ..CollisionRow::new(ids, row.jacobian(), inertia, rate)
            }
        });
        self.impact.set_rows(made);
        self.impact.set_restitution(settings.rigid.restitution);
        for (place, &row) in self.listed.iter().enumerate() {
            let row = &rows[row as usize];
            if !row.slip.line.is_some() {
                continue;
            }
            let inertia = row.bodies(bodies.count()).map(|body| bodies.inertia(body));
            let rate = row.slip_rate(velocities) - row.slip.running;
            let friction = FrictionRow {
                tangential_elasticity: row.slip.elasticity,
                ..FrictionRow::new(row.slip.line.jacobian(), inertia, rate, row.slip.bounds[1])
            };
            self.impact.set_friction(place, friction);
        }
        settings.rigid.impact_law.resolve(&mut self.impact, settings.rigid.order, index)?;
        for (place, &row) in self.listed.iter().enumerate() {
            let row = &mut rows[row as usize];
            row.blows = [self.impact.impulses()[place], self.impact.friction_impulse(place)];
            let [a, b] = row.ends();
            let ids = row.bodies(bodies.count());
            let [mut p, mut q] = ids.map(|body| {
                let InverseInertia { inverse_mass, inverse_moment } = bodies.inertia(body);
                let velocity = velocities[if body.is_world() { bodies.count() } else { body.index() }];
                Mover { velocity, inverse_mass, inverse_moment }
            });
            row.push_two(&mut p, &mut q, row.blows[0]);
            row.slip.line.push(&mut p, &mut q, row.blows[1]);
            (velocities[a], velocities[b]) = (p.velocity, q.velocity);
            if let Some(Third { place, arm }) = row.third() {
                let inertia = bodies.inertia(BodyId(place));
                velocities[place as usize][2] += inertia.inverse_moment * arm * row.blows[0];
            }
        }
        Ok(())
    }
}
