//! A row in the form in which sweeps visit it.
//!
//! *Invariant*: a visit changes the velocities by the response to the change of the impulses, and nothing else.

use crate::stepping::bodies::Motion3;
use crate::stepping::rows::{Line, Mover, Row};

/// A row as sweeps need it: [`Row`] without what they do not read.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Swept {
    pub(super) normal: [f64; 4],
    pub(super) slip: [f64; 4],
    /// Along the normal and along the surface: what is asked of the rate less the rate [m/s], change of the rate by a unit impulse
    /// [1/kg], the inverse of it, and the impulse [N s].
    pub(super) offsets: [f64; 2],
    pub(super) compliances: [f64; 2],
    pub(super) weights: [f64; 2],
    pub(super) impulses: [f64; 2],
    /// Change of the rate along the surface by a unit impulse along the normal [1/kg].
    pub(super) coupling: f64,
    /// Least impulse along the normal [N s].
    pub(super) least: f64,
    /// As of [`Slip`](crate::stepping::rows::Slip).
    pub(super) bounds: [f64; 2],
    /// Mean rates over the kick without the impulses, less what drives and surfaces prescribe [m/s].
    pub(super) free: [f64; 2],
    /// Rates without the impulses [m/s].
    pub(super) kicked: [f64; 2],
    /// Impulses before a round of sweeps, and the direction along which they go on after it [N s].
    pub(super) before: [f64; 2],
    pub(super) conjugate: [f64; 2],
    pub(super) places: [u32; 2],
    /// The places of those bodies that can move; behind the last for others.
    pub(super) noted: [u32; 2],
    /// Place in the list of the island.
    pub(super) listed: u32,
}

/// A row that is visited apart from the others.
#[derive(Clone, Copy, Debug)]
pub(super) struct SweptApart {
    pub(super) row: u32,
    /// Mean rate over the kick without the impulses, less what drives prescribe [m/s].
    pub(super) free: f64,
    /// Rate without the impulses [m/s].
    pub(super) kicked: f64,
}

impl SweptApart {
    /// The row at a place, if it is to be visited apart; the velocities do not include the impulses yet.
    pub(super) fn of(rows: &[Row], place: u32, movers: &[Mover], before: &[Motion3]) -> Option<Self> {
        let row = &rows[place as usize];
        row.apart?;
        let kicked = row.change_of(movers);
        let free = 0.5 * (row.change(before) + kicked) + row.prescribed.unwrap_or(0.0);
        Some(Self { row: place, free, kicked })
    }
}

impl Swept {
    pub(super) fn of(row: &Row, listed: u32, movers: &[Mover], before: &[Motion3]) -> Self {
        let (normal, slip) = (&row.normal, &row.slip.line);
        let ends = row.ends().map(|place| &movers[place]);
        let [p, q] = row.ends().map(|place| &before[place]);
        let kicked = |line: &Line| line.rate(&ends[0].velocity, &ends[1].velocity);
        let mean = |line: &Line| 0.5 * (line.rate(p, q) + kicked(line));
        Self {
            normal: normal.arms(),
            slip: slip.arms(),
            offsets: [normal.offset, slip.offset],
            compliances: [normal.compliance, slip.compliance],
            weights: [normal.weight, slip.weight],
            impulses: [normal.impulse, slip.impulse],
            coupling: slip.coupling(normal, ends),
            least: if row.is_bilateral { f64::NEG_INFINITY } else { 0.0 },
            bounds: row.slip.bounds,
            free: [mean(normal) + row.prescribed.unwrap_or(0.0), mean(slip) - row.slip.running],
            kicked: [kicked(normal), kicked(slip)],
            before: [normal.impulse, slip.impulse],
            conjugate: [0.0; 2],
            places: row.places,
            noted: row.places.map(|place| {
                if movers[place as usize].inverse_mass > 0.0 { place } else { movers.len() as u32 }
            }),
            listed,
        }
    }

    #[inline(always)]
    pub(super) fn ends(&self) -> [usize; 2] {
        self.places.map(|place| place as usize)
    }

    /// Adds to the velocities of its bodies what impulses along the normal and along the surface change.
    #[inline(always)]
    pub(super) fn push(&self, movers: &mut [Mover], [normal, slip]: [f64; 2]) {
        let [x, y, a, b]: [f64; 4] = std::array::from_fn(|k| self.normal[k] * normal + self.slip[k] * slip);
        let [first, second] = self.ends();
        // Nothing is written to what cannot move: rows would wait for each other at the floor.
        let p = &mut movers[first];
        if p.inverse_mass > 0.0 {
            p.velocity[0] += p.inverse_mass * x;
            p.velocity[1] += p.inverse_mass * y;
            p.velocity[2] += p.inverse_moment * a;
        }
        let q = &mut movers[second];
        if q.inverse_mass > 0.0 {
            q.velocity[0] -= q.inverse_mass * x;
            q.velocity[1] -= q.inverse_mass * y;
            q.velocity[2] += q.inverse_moment * b;
        }
    }

    /// Gets the impulses by which it does what is asked; returns the largest change of its rates that these make by themselves [m/s].
    #[inline(always)]
    pub(super) fn visit(&mut self, movers: &mut [Mover]) -> f64 {
        let [p, q] = self.ends().map(|place| movers[place].velocity);
        let (x, y) = (p[0] - q[0], p[1] - q[1]);
        let rate = |[jx, jy, ja, jb]: &[f64; 4]| (jx * x + jy * y) + (ja * p[2] + jb * q[2]);
        let rates = [rate(&self.normal) + self.offsets[0], rate(&self.slip) + self.offsets[1]];
        let pressing = (self.impulses[0] - rates[0] * self.weights[0]).max(self.least);
        let pressed = pressing - self.impulses[0];
        let wanted = self.impulses[1] - (rates[1] + self.coupling * pressed) * self.weights[1];
        let [sticking, slipping] = self.bounds.map(|bound| bound * pressing.max(0.0));
        let bound = if wanted.abs() <= sticking { sticking } else { slipping };
        let held = wanted.min(bound).max(-bound);
        let slipped = held - self.impulses[1];
        self.impulses = [pressing, held];
        self.push(movers, [pressed, slipped]);
        (pressed * self.compliances[0]).abs().max((slipped * self.compliances[1]).abs())
    }
}
