//! The rows of a step: what contacts and connectors ask of the velocities with which bodies go through it.
//!
//! *Invariant*: a row acts on two bodies by their places; that of the background is behind the last body, and has no response.

use glam::DVec2;
use halfgap_collision::BodyId;
use halfgap_contact::InverseInertia;

/// One direction in which a row acts.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Line {
    /// J: coefficients of the velocities of both bodies.
    pub(super) jacobian: [f64; 6],
    /// J M^-1: change of these velocities by a unit of impulse.
    pub(super) response: [f64; 6],
    /// 1/(J M^-1 J^T), the impulse that changes the rate by one [kg].
    pub(super) weight: f64,
    /// Acceleration [m/s^2] when no body accelerates.
    pub(super) gamma: f64,
    /// What is added to the rate to get what is asked of [m/s].
    pub(super) offset: f64,
    /// Impulse [N s] of the problem that is being solved.
    pub(super) impulse: f64,
}

impl Line {
    pub(super) fn new(jacobian: [f64; 6], [a, b]: [InverseInertia; 2], gamma: f64) -> Self {
        let inverse =
            [a.inverse_mass, a.inverse_mass, a.inverse_moment, b.inverse_mass, b.inverse_mass, b.inverse_moment];
        let response: [f64; 6] = std::array::from_fn(|k| jacobian[k] * inverse[k]);
        let compliance: f64 = (0..6).map(|k| jacobian[k] * response[k]).sum();
        let weight = if compliance > 0.0 { 1.0 / compliance } else { 0.0 };
        Self { jacobian, response, weight, gamma, offset: 0.0, impulse: 0.0 }
    }

    /// J v [m/s].
    #[inline]
    pub(super) fn rate(&self, places: [usize; 2], velocities: &[[f64; 3]]) -> f64 {
        let [[x, y, turn], [u, v, spin]] = places.map(|place| velocities[place]);
        let j = &self.jacobian;
        (j[0] * x + j[1] * y + j[2] * turn) + (j[3] * u + j[4] * v + j[5] * spin)
    }

    /// Adds what an impulse changes to the velocities.
    #[inline]
    pub(super) fn push(&self, places: [usize; 2], velocities: &mut [[f64; 3]], impulse: f64) {
        for (side, place) in places.into_iter().enumerate() {
            for (k, velocity) in velocities[place].iter_mut().enumerate() {
                *velocity += self.response[3 * side + k] * impulse;
            }
        }
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

/// Friction along a surface, or against rolling.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Drag {
    pub(super) line: Line,
    /// Bound of the impulse, as a multiple of that along the normal: [-], or [m] against rolling.
    pub(super) coefficient: f64,
    /// The bound once it gives way.
    pub(super) kinetic: f64,
    /// Way [m] along the surface from where it sticks; 0 where it does not.
    pub(super) off: f64,
    /// Sum of the speeds of the surfaces [m/s]: the rate less this is the slip.
    pub(super) running: f64,
    /// Share of the slip that an impact gives back [-].
    pub(super) tangential_elasticity: f64,
}

/// Share of a bound that is rounding [-]: contacts that share a load by redundant forces may all be near their bounds and stick.
const ROUNDED: f64 = 1e-9;

impl Drag {
    /// True if it slips, in a solution of its problem with a bound `most` of its impulse: of the way to this bound and the impulse
    /// `slip` that would stop it, one is rounding.
    pub(super) fn slips(impulse: f64, most: f64, slip: f64) -> bool {
        slip.abs() > (most - impulse.abs()).abs().max(ROUNDED * most)
    }

    /// Impulse [N s] that would stop what slips at given velocities.
    pub(super) fn stopping(&self, places: [usize; 2], velocities: &[[f64; 3]]) -> f64 {
        (self.line.rate(places, velocities) + self.line.offset) * self.line.weight
    }
}

/// A contact, or a direction of a connector.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Row {
    pub(super) source: Source,
    pub(super) bodies: [BodyId; 2],
    pub(super) places: [usize; 2],
    /// Point of the primary body at which the row acts [m].
    pub(super) point: DVec2,
    /// The rate may neither be negative nor positive.
    pub(super) is_bilateral: bool,
    /// Gap above its target [m].
    pub(super) gap: f64,
    /// It carried a force in the last step.
    pub(super) presses: bool,
    /// It did, or is close enough for one.
    pub(super) touches: bool,
    pub(super) elasticity: f64,
    /// Speed [m/s] of the impact at the start of the step, if there is one.
    pub(super) strikes: Option<f64>,
    /// Speed [m/s] of the impact at its end, if there is one.
    pub(super) arrives: Option<f64>,
    pub(super) normal: Line,
    pub(super) slip: Option<Drag>,
    pub(super) roll: Option<Drag>,
}

impl Row {
    /// True if an impact gives back some of the speed that it takes.
    pub(super) fn rebounds(&self) -> bool {
        self.elasticity > 0.0 || self.slip.as_ref().is_some_and(|slip| slip.tangential_elasticity > 0.0)
    }

    /// Adds to the velocities what all impulses of the row, times a factor, change.
    pub(super) fn push_all(&self, velocities: &mut [[f64; 3]], factor: f64) {
        let Self { places, normal, slip, roll, .. } = self;
        for line in [Some(normal), slip.as_ref().map(|drag| &drag.line), roll.as_ref().map(|drag| &drag.line)] {
            if let Some(line) = line.filter(|line| line.impulse != 0.0) {
                line.push(*places, velocities, factor * line.impulse);
            }
        }
    }

    /// Impulses along the normal, along the surface, and against rolling.
    pub(super) fn impulses(&self) -> [f64; 3] {
        let of = |drag: &Option<Drag>| drag.as_ref().map_or(0.0, |drag| drag.line.impulse);
        [self.normal.impulse, of(&self.slip), of(&self.roll)]
    }

    /// Sets the impulses along the normal, along the surface, and against rolling.
    pub(super) fn set_impulses(&mut self, [normal, slip, roll]: [f64; 3]) {
        self.normal.impulse = normal;
        for (drag, impulse) in [(&mut self.slip, slip), (&mut self.roll, roll)] {
            if let Some(drag) = drag {
                drag.line.impulse = impulse;
            }
        }
    }
}
