//! The rows of a step: what contacts and connectors ask of the velocities with which bodies go through it.
//!
//! *Invariant*: a row acts on two bodies by their places; that of the background is behind the last body, and nothing moves it. Few rows
//! are of another form: see `apart`.

use crate::stepping::apart::Apart;
use crate::stepping::balance::Balance;
use crate::stepping::bodies::Motion3;
use glam::DVec2;
use halfgap_collision::BodyId;
use halfgap_contact::InverseInertia;

/// Share of a bound that is rounding [-]: contacts that share a load by redundant forces may all be near their bounds and stick.
const ROUNDED: f64 = 1e-9;

/// A velocity that is looked for, and what an impulse and its moment change of it: nothing of a body that cannot move.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[repr(align(64))]
pub(super) struct Mover {
    pub(super) velocity: Motion3,
    pub(super) inverse_mass: f64,
    pub(super) inverse_moment: f64,
}

impl Mover {
    /// Kinetic energy [J] at a velocity; 0 for what cannot move.
    pub(super) fn energy(&self, [x, y, spin]: Motion3) -> f64 {
        if self.inverse_mass > 0.0 {
            0.5 * ((x * x + y * y) / self.inverse_mass + spin * spin / self.inverse_moment)
        } else {
            0.0
        }
    }
}

/// One direction in which a row acts: J = [x, y, a, -x, -y, b].
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Line {
    x: f64,
    y: f64,
    a: f64,
    b: f64,
    /// J M^-1 J^T [1/kg].
    pub(super) compliance: f64,
    /// 1/(J M^-1 J^T), the impulse that changes the rate by one [kg]; 0 where there is no row.
    pub(super) weight: f64,
    /// What is added to the rate to get what is asked of [m/s].
    pub(super) offset: f64,
    /// Impulse [N s] of the problem that is being solved.
    pub(super) impulse: f64,
    /// Impulse [kg m] of a displacement.
    pub(super) before: f64,
}

impl Line {
    pub(super) fn new(jacobian: [f64; 6], [p, q]: [InverseInertia; 2], offset: f64) -> Self {
        let [x, y, a, _, _, b] = jacobian;
        let compliance = (p.inverse_mass + q.inverse_mass) * (x * x + y * y)
            + (p.inverse_moment * a * a + q.inverse_moment * b * b);
        let weight = if compliance > 0.0 { 1.0 / compliance } else { 0.0 };
        Self { x, y, a, b, compliance, weight, offset, ..Self::default() }
    }

    /// The same with another compliance [1/kg].
    pub(super) fn with_compliance(self, compliance: f64) -> Self {
        let weight = if compliance > 0.0 { 1.0 / compliance } else { 0.0 };
        Self { compliance, weight, ..self }
    }

    /// True if there is such a row.
    #[inline]
    pub(super) fn is_some(&self) -> bool {
        self.weight > 0.0
    }

    /// J.
    pub(super) fn jacobian(&self) -> [f64; 6] {
        [self.x, self.y, self.a, -self.x, -self.y, self.b]
    }

    /// [x, y, a, b].
    #[inline]
    pub(super) fn arms(&self) -> [f64; 4] {
        [self.x, self.y, self.a, self.b]
    }

    /// Change of this rate by a unit impulse of another row between the same bodies [1/kg].
    #[inline]
    pub(super) fn coupling(&self, other: &Self, [p, q]: [&Mover; 2]) -> f64 {
        (p.inverse_mass + q.inverse_mass) * (self.x * other.x + self.y * other.y)
            + (p.inverse_moment * self.a * other.a + q.inverse_moment * self.b * other.b)
    }

    /// J v [m/s] of two velocities.
    #[inline(always)]
    pub(super) fn rate(&self, p: &Motion3, q: &Motion3) -> f64 {
        (self.x * (p[0] - q[0]) + self.y * (p[1] - q[1])) + (self.a * p[2] + self.b * q[2])
    }

    /// Adds what an impulse changes to the velocities.
    #[inline(always)]
    pub(super) fn push(&self, p: &mut Mover, q: &mut Mover, impulse: f64) {
        let (x, y) = (self.x * impulse, self.y * impulse);
        p.velocity[0] += p.inverse_mass * x;
        p.velocity[1] += p.inverse_mass * y;
        p.velocity[2] += p.inverse_moment * self.a * impulse;
        q.velocity[0] -= q.inverse_mass * x;
        q.velocity[1] -= q.inverse_mass * y;
        q.velocity[2] += q.inverse_moment * self.b * impulse;
    }

    /// Changes the impulse, and the velocities by it.
    #[inline(always)]
    pub(super) fn set(&mut self, p: &mut Mover, q: &mut Mover, impulse: f64) {
        self.push(p, q, impulse - self.impulse);
        self.impulse = impulse;
    }

    /// Impulse at which the row would do what is asked [N s].
    #[inline(always)]
    pub(super) fn wanted(&self, p: &Mover, q: &Mover) -> f64 {
        self.impulse - (self.rate(&p.velocity, &q.velocity) + self.offset) * self.weight
    }

    /// True if a row with a bound `most` of its impulse slips, in a solution of its problem, where the impulse `stopping` would stop
    /// it: of this and the way to the bound, one is rounding.
    pub(super) fn slips(impulse: f64, most: f64, stopping: f64) -> bool {
        stopping.abs() > (most - impulse.abs()).abs().max(ROUNDED * most)
    }
}

/// Where a row comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum Source {
    /// A contact, by the places of its pair and in it.
    Contact { pair: u32, contact: u32 },
    /// A direction of a connector.
    Connector { connector: u32, direction: u32 },
}

/// Friction along the surfaces of a contact; no row without friction.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Slip {
    pub(super) line: Line,
    /// Bound of the impulse as a multiple of that along the normal [-]: until it gives way, and then.
    pub(super) bounds: [f64; 2],
    /// Way [m] along the surface from where it sticks; 0 where it does not.
    pub(super) off: f64,
    /// Sum of the speeds of the surfaces [m/s]: the rate less this is the slip.
    pub(super) running: f64,
    /// Share of the slip that an impact gives back [-].
    pub(super) elasticity: f64,
}

/// Resistance of a contact against rolling.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Roll {
    /// The row of the contact.
    pub(super) row: u32,
    pub(super) line: Line,
    /// Bound of the impulse as a multiple of that along the normal [m].
    pub(super) bound: f64,
}

/// Lengths of a step that decide what is near.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengths {
    /// Length of the step [s].
    pub(super) span: f64,
    /// Time at its start [s].
    pub(super) time: f64,
    /// Time since the start of the step before [s].
    pub(super) since_last: f64,
    /// Speed that forces give in the step [m/s].
    pub(super) fall: f64,
    /// Gap at which bodies touch [m].
    pub(super) target_gap: f64,
    /// Error of positions that does not matter [m].
    pub(super) slack: f64,
}

/// A contact, or a direction of a connector.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Row {
    pub(super) places: [u32; 2],
    /// What it has beyond its line, if it is not of the form of contacts.
    pub(super) apart: Option<Apart>,
    /// The rate may neither be negative nor positive.
    pub(super) is_bilateral: bool,
    /// Part of the rate [m/s] that a drive or a motor prescribes; none for what does not drive.
    pub(super) prescribed: Option<f64>,
    /// It carried a force in the last step.
    pub(super) presses: bool,
    /// It did, or is close enough for one.
    pub(super) touches: bool,
    /// Place of its resistance against rolling, if it has one.
    pub(super) roll: Option<u32>,
    pub(super) normal: Line,
    pub(super) slip: Slip,
    /// Gap above its target [m], and its acceleration when no body accelerates [m/s^2].
    pub(super) gap: f64,
    pub(super) gamma: f64,
    pub(super) elasticity: f64,
    /// Speed [m/s] of the impact at the start of the step, if there is one.
    pub(super) strikes: Option<f64>,
    /// Impulses [N s] along the normal and along the surface of the impact at the start of the step; 0 without one.
    pub(super) blows: [f64; 2],
    /// Speed [m/s] of the impact at its end, if there is one.
    pub(super) arrives: Option<f64>,
    /// Point of the primary body at which the row acts [m].
    pub(super) point: DVec2,
    pub(super) source: Source,
}

impl Row {
    /// The places of its bodies.
    #[inline(always)]
    pub(super) fn ends(&self) -> [usize; 2] {
        self.places.map(|place| place as usize)
    }

    /// Its two bodies, among so many.
    pub(super) fn bodies(&self, count: usize) -> [BodyId; 2] {
        self.places.map(|place| if place as usize == count { BodyId::WORLD } else { BodyId(place) })
    }

    /// True for a direction of a connector.
    #[inline]
    pub(super) fn is_tie(&self) -> bool {
        matches!(self.source, Source::Connector { .. })
    }

    /// True if an impact gives back some of the speed that it takes.
    #[inline]
    pub(super) fn rebounds(&self) -> bool {
        self.elasticity > 0.0 || self.slip.elasticity > 0.0
    }

    /// Lets the row strike if it has come to touch, at a rate [m/s], without having been slowed down before.
    pub(super) fn meet(&mut self, rate: f64) {
        let is_met = !self.is_bilateral && !self.pulls();
        let has_come = is_met && self.touches && !self.presses && rate < 0.0;
        if self.strikes.is_none() && has_come && self.rebounds() {
            self.strikes = Some(-rate);
        }
    }

    /// J v [m/s] along the normal, with what is prescribed.
    #[inline]
    pub(super) fn rate(&self, velocities: &[Motion3]) -> f64 {
        self.change(velocities) + self.prescribed.unwrap_or(0.0)
    }

    /// J v [m/s] along the normal, or the speed of the impact against it if that is more.
    #[inline]
    pub(super) fn striking_rate(&self, velocities: &[Motion3]) -> f64 {
        let rate = self.rate(velocities);
        self.strikes.map_or(rate, |speed| rate.min(-speed))
    }

    /// J v [m/s] along the surface.
    pub(super) fn slip_rate(&self, velocities: &[Motion3]) -> f64 {
        let [a, b] = self.ends();
        self.slip.line.rate(&velocities[a], &velocities[b])
    }

    /// Adds to the balance of some rows what impulses along the normal and along the surface do, if `rates` are the sums of those before and
    /// after them.
    pub(super) fn weigh(&self, [normal, slip]: [f64; 2], rates: [f64; 2], balance: &mut Balance) {
        balance.add(0.5 * normal * rates[0]);
        balance.add(slip * (0.5 * rates[1] - self.slip.running));
    }

    /// Adds to the velocities what the impulses of the row change.
    #[inline]
    pub(super) fn push_impulses(&self, movers: &mut [Mover]) {
        self.push(movers, self.normal.impulse);
        if self.slip.line.is_some() {
            let [a, b] = self.ends();
            let (mut p, mut q) = (movers[a], movers[b]);
            self.slip.line.push(&mut p, &mut q, self.slip.line.impulse);
            (movers[a], movers[b]) = (p, q);
        }
    }
}

/// All rows of a step.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Rows {
    pub(super) all: Vec<Row>,
    pub(super) rolls: Vec<Roll>,
    /// Deepest overlap [m].
    pub(super) deepest: f64,
    /// Some contact has struck, some rebounds.
    pub(super) strikes: bool,
    pub(super) rebounds: bool,
    /// There is a row of a connector; some drive, or rub.
    pub(super) ties: bool,
    pub(super) drives: bool,
}

impl Rows {
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.rolls.clear();
        self.deepest = 0.0;
        (self.strikes, self.rebounds, self.ties, self.drives) = (false, false, false, false);
    }

    pub(super) fn push(&mut self, row: Row) {
        if !row.is_bilateral {
            self.deepest = self.deepest.max(-row.gap);
        }
        self.strikes |= row.strikes.is_some();
        self.rebounds |= row.rebounds();
        self.ties |= row.is_tie();
        self.drives |= row.prescribed.is_some() || row.pulls();
        self.all.push(row);
    }
}
