//! What the surface of a body does to one that touches it, and how the surfaces of two bodies go together.

/// Friction and restitution along the surface of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Surface {
    /// Kinetic Coulomb coefficient [-]; a pair uses the geometric mean.
    pub friction: f64,
    /// Coefficient [-] up to which a contact sticks; a pair uses the geometric mean, which must not be below the kinetic one.
    pub static_friction: f64,
    /// Speed [m/s] at which the surface runs along the outline, counter-clockwise positive.
    pub velocity: f64,
    /// Torque against rolling [-], as a multiple of normal force and radius; a pair uses the greater.
    pub rolling_resistance: f64,
    /// Share [-] of the slip speed that an impact gives back, 0 to 1; a pair uses the lesser.
    pub tangential_elasticity: f64,
}

impl Surface {
    /// A surface without friction.
    pub const SMOOTH: Self = Self {
        friction: 0.0,
        static_friction: 0.0,
        velocity: 0.0,
        rolling_resistance: 0.0,
        tangential_elasticity: 0.0,
    };

    /// True if it has friction with itself.
    #[must_use]
    #[inline]
    pub fn has_friction(&self) -> bool {
        self.friction > 0.0 || self.static_friction > 0.0
    }

    /// True if it resists slip or rolling.
    #[must_use]
    #[inline]
    pub fn resists(&self) -> bool {
        self.has_friction() || self.rolling_resistance > 0.0
    }
}

/// The surfaces of two bodies that touch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct PairSurface {
    /// Coefficient of a contact that slips [-].
    pub kinetic: f64,
    /// Coefficient up to which a contact sticks [-].
    pub sticking: f64,
    /// Speeds [m/s] of both surfaces, in the order of the bodies.
    pub speeds: [f64; 2],
    /// Rolling resistance [-].
    pub rolling: f64,
    /// Tangential elasticity [-].
    pub tangential_elasticity: f64,
}

impl PairSurface {
    /// The surfaces of two bodies together.
    #[must_use]
    pub fn of([a, b]: [&Surface; 2]) -> Self {
        Self {
            kinetic: mean(a.friction, b.friction),
            sticking: mean(a.static_friction, b.static_friction),
            speeds: [a.velocity, b.velocity],
            rolling: a.rolling_resistance.max(b.rolling_resistance),
            tangential_elasticity: a.tangential_elasticity.min(b.tangential_elasticity),
        }
    }

    /// True if the contact can carry a force along the surface.
    #[must_use]
    #[inline]
    pub fn has_friction(&self) -> bool {
        self.kinetic > 0.0 || self.sticking > 0.0
    }
}

/// Friction at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RowFriction {
    /// Force on the primary body along the normal turned by +90 degrees [N]. Where forces are redundant it is shared among contacts
    /// of one slip as they press.
    pub force: f64,
    /// Slip speed [m/s] of the primary side's surface against the other, along the same direction; 0 of a contact that sticks.
    pub slip_speed: f64,
    /// Largest friction [N] that the contact can bear, sticking or slipping as it does.
    pub most: f64,
    /// True if it sticks.
    pub sticks: bool,
}

/// Rolling resistance at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RowRolling {
    /// Moment on the primary body [N m], counter-clockwise positive; the other one gets the opposite.
    pub moment: f64,
    /// Radius at which the features roll on each other [m].
    pub radius: f64,
}

/// The geometric mean; to the bit one of the two if they are equal.
fn mean(a: f64, b: f64) -> f64 {
    if a == b { a } else { (a * b).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_coefficients_keep_their_bits() {
        for thousandths in 1..2000 {
            let friction = f64::from(thousandths) / 1000.0;
            let surface = Surface { friction, static_friction: friction, ..Surface::default() };
            let pair = PairSurface::of([&surface, &surface]);
            assert_eq!([pair.kinetic, pair.sticking], [friction; 2]);
        }
    }

    #[test]
    fn pairs_mix_as_the_fields_say() {
        let rough = Surface {
            friction: 0.9,
            static_friction: 1.6,
            velocity: 2.0,
            rolling_resistance: 0.1,
            tangential_elasticity: 0.5,
        };
        let plain = Surface {
            friction: 0.4,
            static_friction: 0.9,
            velocity: -1.0,
            rolling_resistance: 0.3,
            tangential_elasticity: 0.2,
        };
        let pair = PairSurface::of([&rough, &plain]);
        assert!((pair.kinetic - 0.6).abs() < 1e-15 && (pair.sticking - 1.2).abs() < 1e-15);
        assert_eq!((pair.speeds, pair.rolling, pair.tangential_elasticity), ([2.0, -1.0], 0.3, 0.2));
        assert!(pair.has_friction());
        assert!(!PairSurface::of([&rough, &Surface::default()]).has_friction());
    }
}
