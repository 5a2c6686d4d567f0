//! Rows that are not of the form of contacts: those of three bodies, as of gears on a carrier, those that push their two bodies along
//! different directions, as of racks and pulleys, and those whose force is bounded, as of motors and dry friction in joints.
//!
//! *Invariant*: what a row does to all its bodies is told here; sweeps visit such rows apart from the others, which know nothing of them.

use crate::stepping::bodies::Motion3;
use crate::stepping::rows::{Line, Mover, Row};
use halfgap_contact::InverseInertia;

/// The third side of a row: the rotation of one more body.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Third {
    /// Place of the body.
    pub(super) place: u32,
    /// Coefficient of its angular velocity [m].
    pub(super) arm: f64,
}

/// What a row has beyond its line.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Apart {
    /// Coefficients of the velocity of the second body [-]: a contact has those of the first with the other sign.
    pub(super) second: [f64; 2],
    pub(super) third: Option<Third>,
    /// Largest size of the impulse [N s]; infinite but for what pulls.
    pub(super) most: f64,
}

impl Apart {
    /// J v [m/s], for the line of its row.
    #[inline]
    fn rate(&self, line: &Line, [p, q]: [&Motion3; 2], spin: impl Fn(u32) -> f64) -> f64 {
        let [x, y, a, .., b] = line.jacobian();
        let [u, v] = self.second;
        let of_two = (x * p[0] + y * p[1] + a * p[2]) + (u * q[0] + v * q[1] + b * q[2]);
        self.third.map_or(of_two, |Third { place, arm }| of_two + arm * spin(place))
    }

    /// J M^-1 J^T [1/kg], for the line of its row; the inverse moment of a third body is told by its place.
    pub(super) fn compliance(
        &self,
        line: &Line,
        [p, q]: [InverseInertia; 2],
        inverse_moment: impl Fn(u32) -> f64,
    ) -> f64 {
        let [x, y, a, .., b] = line.jacobian();
        let [u, v] = self.second;
        let of_third = self.third.map_or(0.0, |Third { place, arm }| inverse_moment(place) * arm * arm);
        p.inverse_mass * (x * x + y * y)
            + q.inverse_mass * (u * u + v * v)
            + (p.inverse_moment * a * a + q.inverse_moment * b * b)
            + of_third
    }
}

impl Row {
    /// J for its first two bodies.
    pub(super) fn jacobian(&self) -> [f64; 6] {
        let [x, y, a, u, v, b] = self.normal.jacobian();
        let [u, v] = self.apart.map_or([u, v], |apart| apart.second);
        [x, y, a, u, v, b]
    }

    pub(super) fn third(&self) -> Option<Third> {
        self.apart.and_then(|apart| apart.third)
    }

    /// True for a motor, and for dry friction in a joint: in no time, as in an impact, it does nothing.
    #[inline]
    pub(super) fn pulls(&self) -> bool {
        self.apart.is_some_and(|apart| apart.most < f64::INFINITY)
    }

    /// The least and the most impulse that it may have [N s].
    #[inline]
    pub(super) fn bounds(&self) -> [f64; 2] {
        let most = self.apart.map_or(f64::INFINITY, |apart| apart.most);
        let least = if self.is_bilateral || self.pulls() { -most } else { 0.0 };
        [least, most]
    }

    /// The places of all bodies on which it acts.
    #[inline(always)]
    pub(super) fn all_ends(&self) -> impl Iterator<Item = usize> + use<> {
        self.ends().into_iter().chain(self.third().map(|third| third.place as usize))
    }

    /// J v [m/s] along the normal, without what is prescribed: also of accelerations and of displacements.
    #[inline]
    pub(super) fn change(&self, velocities: &[Motion3]) -> f64 {
        let [p, q] = self.ends().map(|place| &velocities[place]);
        match &self.apart {
            None => self.normal.rate(p, q),
            Some(apart) => apart.rate(&self.normal, [p, q], |place| velocities[place as usize][2]),
        }
    }

    /// The same of velocities that are looked for.
    #[inline]
    pub(super) fn change_of(&self, movers: &[Mover]) -> f64 {
        let [p, q] = self.ends().map(|place| &movers[place].velocity);
        match &self.apart {
            None => self.normal.rate(p, q),
            Some(apart) => apart.rate(&self.normal, [p, q], |place| movers[place as usize].velocity[2]),
        }
    }

    /// Adds what an impulse along the normal changes to the velocities of its first two bodies.
    #[inline]
    pub(super) fn push_two(&self, p: &mut Mover, q: &mut Mover, impulse: f64) {
        let Some(apart) = &self.apart else {
            self.normal.push(p, q, impulse);
            return;
        };
        let ([x, y, a, b], [u, v]) = (self.normal.arms(), apart.second);
        for (mover, [j, k, l]) in [(p, [x, y, a]), (q, [u, v, b])] {
            mover.velocity[0] += mover.inverse_mass * j * impulse;
            mover.velocity[1] += mover.inverse_mass * k * impulse;
            mover.velocity[2] += mover.inverse_moment * l * impulse;
        }
    }

    /// Adds what an impulse along the normal changes to the velocities.
    #[inline]
    pub(super) fn push(&self, movers: &mut [Mover], impulse: f64) {
        let [a, b] = self.ends();
        let (mut p, mut q) = (movers[a], movers[b]);
        self.push_two(&mut p, &mut q, impulse);
        (movers[a], movers[b]) = (p, q);
        if let Some(Third { place, arm }) = self.third() {
            let mover = &mut movers[place as usize];
            mover.velocity[2] += mover.inverse_moment * arm * impulse;
        }
    }

    /// Lets the row do what is asked of it, so far as it may; returns the change of its rate by that [m/s].
    pub(super) fn hold(&mut self, movers: &mut [Mover]) -> f64 {
        let [least, most] = self.bounds();
        let Line { impulse: before, weight, offset, compliance, .. } = self.normal;
        let wanted = before - (self.change_of(movers) + offset) * weight;
        let held = wanted.min(most).max(least);
        self.push(movers, held - before);
        self.normal.impulse = held;
        ((held - before) * compliance).abs()
    }
}
