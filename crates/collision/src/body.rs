//! A body as collisions see it: a shape about its centre of mass, its inertia and its elasticity.

use crate::motion::BodyState;
use halfgap_geometry::Shape;

/// Index of a body in its world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyId(pub u32);

impl BodyId {
    /// The immovable background, to which connectors may tie a body: no body of the world, with the pose of the origin.
    pub const WORLD: BodyId = BodyId(u32::MAX);

    /// The id of the body at an index of a list of bodies.
    ///
    /// # Panics
    /// If the index is 2^32 - 1, which stands for the background, or more.
    #[must_use]
    #[inline]
    pub fn from_index(index: usize) -> Self {
        let number = u32::try_from(index).ok().filter(|&number| number != Self::WORLD.0);
        Self(number.expect("bodies are fewer than 2^32 - 1"))
    }

    /// True for the background.
    #[must_use]
    #[inline]
    pub fn is_world(self) -> bool {
        self == Self::WORLD
    }

    /// The index as a `usize`, for lists of bodies.
    #[must_use]
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A rigid body. The origin of its shape's coordinates is the centre of mass.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Body {
    /// Shape in body coordinates.
    pub shape: Shape,
    /// 1/mass [1/kg]; 0 for a fixed body.
    pub inverse_mass: f64,
    /// 1/moment of inertia about the centre of mass [1/(kg m^2)]; 0 for a fixed body.
    pub inverse_moment: f64,
    /// Coefficient of restitution [-], 0 to 1: the fraction of the closing speed that remains after an impact. A pair
    /// of bodies uses the lesser of the two.
    pub elasticity: f64,
}

impl Body {
    /// True for a fixed body: both its inverse mass and its inverse moment are 0.
    #[must_use]
    #[inline]
    pub fn is_fixed(&self) -> bool {
        self.inverse_mass == 0.0 && self.inverse_moment == 0.0
    }

    /// Kinetic energy \[J\] in a state. Translation counts as 0 if the inverse mass is 0, rotation if the inverse
    /// moment is.
    #[must_use]
    #[inline]
    pub fn kinetic_energy(&self, state: &BodyState) -> f64 {
        let part = |square: f64, inverse: f64| if inverse > 0.0 { 0.5 * square / inverse } else { 0.0 };
        part(state.velocity.length_squared(), self.inverse_mass)
            + part(state.angular_velocity.powi(2), self.inverse_moment)
    }
}
