//! What acts on the free coordinate of a connector: motors, limits, dry friction, and drives.
//!
//! The coordinate of a pin is the angle of its second body less that of its first, that of a slider the way of its body
//! along the axis.

/// What acts on the free coordinate of a connector. An angle is in rad, its forces in N m; a way is in m and N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OnJoint {
    /// A motor.
    pub motor: Option<Motor>,
    /// Lower and upper limit; a body that meets one stays there until something takes it away.
    pub limits: Option<[f64; 2]>,
    /// Dry friction: most that it takes.
    pub friction: f64,
    /// Rate that it has, whatever that takes.
    pub rate: Option<f64>,
}

/// A motor: it pulls towards a speed, and holds that while it can.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Speed [rad/s or m/s].
    pub speed: f64,
    /// Most that it pulls [N m or N].
    pub most: f64,
}

impl OnJoint {
    /// A motor with a speed and the most that it pulls.
    #[must_use]
    pub fn motor(speed: f64, most: f64) -> Self {
        Self { motor: Some(Motor { speed, most }), ..Self::default() }
    }

    /// Limits.
    #[must_use]
    pub fn limits(lower: f64, upper: f64) -> Self {
        Self { limits: Some([lower, upper]), ..Self::default() }
    }

    /// Dry friction.
    #[must_use]
    pub fn friction(friction: f64) -> Self {
        Self { friction, ..Self::default() }
    }

    /// A constant rate.
    #[must_use]
    pub fn rate(rate: f64) -> Self {
        Self { rate: Some(rate), ..Self::default() }
    }

    /// What an engine needs that has motors only: friction is a motor that stands, and a drive one that pulls as much as
    /// is wanted, with `most` in place of that.
    #[must_use]
    pub fn as_motor(&self, most: f64) -> Option<Motor> {
        let friction = (self.friction > 0.0).then_some(Motor { speed: 0.0, most: self.friction });
        let drive = self.rate.map(|speed| Motor { speed, most });
        self.motor.or(friction).or(drive)
    }
}
