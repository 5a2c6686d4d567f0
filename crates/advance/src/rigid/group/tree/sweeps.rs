//! Accelerations of a tree by the articulated-body algorithm: R. Featherstone, Rigid Body Dynamics Algorithms (2008),
//! chapter 7, written for pins in the plane.
//!
//! The bodies that hang on a pin resist its acceleration a by the force A a + d. The unknowns of a body are the
//! acceleration a of its own pin and its angular acceleration alpha. A pin on which others hang, at the arm u from its
//! own pin, adds to both of its equations:
//!
//! ```text
//! force on the pin:  M a + g alpha + e,      M = m + sum A,
//!                                            g = m c' + sum A u',
//!                                            e = sum (d - w^2 A u) - w^2 m c - F
//! moment about it:   g.a + H alpha + h = 0,  H = I + m c^2 + sum u'.A u',
//!                                            h = sum u'.(d - w^2 A u) - c'.F - T
//! ```
//!
//! where c is the arm of the centre of mass, w the angular velocity, F and T force and torque without pins,
//! and ' a quarter turn. The second gives alpha; put into the first, A = M - g g^T/H and d = e - g h/H.

use crate::rigid::group::tree::{Hinge, JointTree, Link, Stance};
use glam::DVec2;

/// A symmetric matrix of order 2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Symmetric {
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Symmetric {
    #[inline]
    fn apply(&self, v: DVec2) -> DVec2 {
        DVec2::new(self.xx * v.x + self.xy * v.y, self.xy * v.x + self.yy * v.y)
    }

    /// Adds another matrix.
    #[inline]
    fn add(&mut self, other: &Symmetric) {
        self.xx += other.xx;
        self.xy += other.xy;
        self.yy += other.yy;
    }

    /// This matrix less g g^T times a factor.
    #[inline]
    fn less_square(&self, g: DVec2, factor: f64) -> Self {
        Self {
            xx: self.xx - factor * g.x * g.x,
            xy: self.xy - factor * g.x * g.y,
            yy: self.yy - factor * g.y * g.y,
        }
    }

    /// Solves A x = v, the larger pivot first.
    #[inline]
    fn solve(&self, v: DVec2) -> DVec2 {
        if self.xx >= self.yy {
            let ratio = self.xy / self.xx;
            let y = (v.y - ratio * v.x) / (self.yy - ratio * self.xy);
            DVec2::new((v.x - self.xy * y) / self.xx, y)
        } else {
            let ratio = self.xy / self.yy;
            let x = (v.x - ratio * v.y) / (self.xx - ratio * self.xy);
            DVec2::new(x, (v.y - self.xy * x) / self.yy)
        }
    }
}

/// Equations of force and of moment of a body: its own part, and those of all bodies that hang on it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Bundle {
    /// M [kg].
    mass: Symmetric,
    /// g [kg m].
    coupling: DVec2,
    /// H [kg m^2].
    moment: f64,
    /// 1 / H, once all parts are added.
    per_moment: f64,
    /// e [N].
    pub(super) force: DVec2,
    /// h [N m].
    pub(super) torque: f64,
    /// Acceleration of the pin [m/s^2].
    pub(super) acceleration: DVec2,
    /// Angular acceleration [rad/s^2].
    pub(super) angular: f64,
}

impl Bundle {
    /// Adds the body's own part; the body has an acceleration (x, y, angle) without pins.
    #[inline]
    fn add_body(&mut self, link: &Link, stance: &Stance, &[x, y, angular]: &[f64; 3]) {
        let (force, center) = (link.mass * DVec2::new(x, y), -stance.own);
        let across = center.perp();
        self.mass.xx += link.mass;
        self.mass.yy += link.mass;
        self.coupling += link.mass * across;
        self.moment += link.moment + link.mass * center.length_squared();
        self.force -= (stance.spin_square * link.mass) * center + force;
        self.torque -= across.dot(force) + link.moment * angular;
    }

    /// d: force [N] of the pin if it does not accelerate.
    #[inline]
    pub(super) fn resistance(&self) -> DVec2 {
        self.force - self.coupling * (self.torque * self.per_moment)
    }

    /// Acceleration [m/s^2] of the own pin of a body that hangs on nothing.
    #[inline]
    pub(super) fn free_acceleration(&self) -> DVec2 {
        self.mass.less_square(self.coupling, self.per_moment).solve(-self.resistance())
    }

    /// Notes the pin's acceleration [m/s^2] and the angular acceleration that follows. Returns the acceleration of the
    /// centre of mass without its centripetal part; `own` is the arm from there to the pin [m].
    #[inline]
    pub(super) fn turn(&mut self, acceleration: DVec2, own: DVec2) -> DVec2 {
        self.acceleration = acceleration;
        self.angular = -(self.coupling.dot(acceleration) + self.torque) * self.per_moment;
        acceleration - own.perp() * self.angular
    }
}

impl JointTree {
    /// Turns accelerations without the forces of pins, body by body of the group, into those with them. The stances
    /// must be up to date.
    pub(super) fn accelerate(&mut self, accelerations: &mut [[f64; 3]]) {
        self.sweep_in(accelerations);
        self.sweep_out(accelerations);
    }

    /// Sweeps from the tips to the roots: adds the equations of each body to those of the body on which it hangs.
    #[inline]
    pub(super) fn sweep_in(&mut self, accelerations: &[[f64; 3]]) {
        self.bundles.fill(Bundle::default());
        for (index, link) in self.links.iter().enumerate().rev() {
            let stance = &self.stances[index];
            let (below, rest) = self.bundles.split_at_mut(index);
            let Some(bundle) = rest.first_mut() else { continue };
            bundle.add_body(link, stance, &accelerations[link.place]);
            bundle.per_moment = bundle.moment.recip();
            let Hinge::Link { parent, .. } = link.hinge else { continue };
            let mass = bundle.mass.less_square(bundle.coupling, bundle.per_moment);
            let arm = stance.of_parent;
            let force = bundle.resistance() - mass.apply(arm) * self.stances[parent].spin_square;
            let across = arm.perp();
            let pulled = mass.apply(across);
            let on = &mut below[parent];
            on.mass.add(&mass);
            on.coupling += pulled;
            on.moment += across.dot(pulled);
            on.force += force;
            on.torque += across.dot(force);
        }
    }

    /// Sweeps from the roots to the tips: finds the accelerations of each pin, then of its body.
    #[inline]
    fn sweep_out(&mut self, accelerations: &mut [[f64; 3]]) {
        for (index, (link, stance)) in self.links.iter().zip(&self.stances).enumerate() {
            let acceleration = match link.hinge {
                Hinge::World(_) => DVec2::ZERO,
                Hinge::Free => self.bundles[index].free_acceleration(),
                Hinge::Link { parent, .. } => {
                    let (on, arm) = (&self.bundles[parent], stance.of_parent);
                    on.acceleration + arm.perp() * on.angular - arm * self.stances[parent].spin_square
                }
            };
            let bundle = &mut self.bundles[index];
            let of_center = bundle.turn(acceleration, stance.own) + stance.own * stance.spin_square;
            accelerations[link.place] = [of_center.x, of_center.y, bundle.angular];
        }
    }
}
