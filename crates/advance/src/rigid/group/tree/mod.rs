//! Trees of bodies that hang on each other by pins: their motion in reduced coordinates, one for each degree of
//! freedom.
//!
//! Where a group is held by pins that close no loop, the angles of its bodies, and the positions of bodies that hang on
//! nothing, determine its state. Steps in these coordinates keep to the pins by themselves and have a third of the
//! components. The accelerations follow from one sweep from the tips to the roots and one back; a system of equations
//! is solved only for the few rows beside the pins. All other modules work with bodies: this one translates at both
//! ends of a step, and its dense output.
//!
//! `build` finds the tree, `placing` goes from coordinates to bodies, `sweeps` finds accelerations, `loop_rows` holds the
//! rows beside the pins, `stepping` makes the steps of a group, `forces` finds the forces of its rows. Angles are those
//! of the bodies, not those between them, so each coordinate of the tree is also a component of the group's state.

mod build;
mod forces;
mod loop_rows;
mod placing;
mod stepping;
mod sweeps;
#[cfg(test)]
mod tests;

use crate::ode::SegmentPolynomial;
use glam::DVec2;
use loop_rows::LoopRows;
use sweeps::Bundle;

/// Support from which a body of a tree hangs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
enum Hinge {
    /// None: the body's position is among the coordinates.
    Free,
    /// A point [m] of the world.
    World(DVec2),
    /// Another body, which comes earlier in the tree.
    Link {
        /// Place of that body in the tree.
        parent: usize,
        /// The pin [m] in that body's coordinates.
        arm: DVec2,
        /// From there to this body's pin [m], in world directions: the gap of the pin when it formed.
        offset: DVec2,
    },
}

/// A body of a tree, with its support.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Link {
    /// Its place in the group.
    place: usize,
    hinge: Hinge,
    /// Its own pin [m] in its coordinates, zero if it is free.
    own: DVec2,
    /// Mass [kg].
    mass: f64,
    /// Moment of inertia about the centre of mass [kg m^2].
    moment: f64,
    /// The largest angle [rad] by which it may turn in a step.
    most_turn: f64,
    /// Sum [m^2], over this body and all that hang on it, of the squares of the distances by which they move per radian
    /// that this one turns; its own points count by its reach.
    lever_square: f64,
    /// Number of bodies that hang on it, directly or by others.
    descendants: usize,
}

/// Arms of a body in world directions, and its angular velocity, as its equations need them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Stance {
    /// From its centre of mass to its own pin [m].
    own: DVec2,
    /// From its parent's own pin to the pin between them [m].
    of_parent: DVec2,
    /// Square of its angular velocity [rad^2/s^2].
    spin_square: f64,
}

/// Index, among a group's positions, of each coordinate of the tree: link by link, the angle, then the position of a
/// free one.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Numbers(Vec<usize>);

/// Numbers of rows beside the pins of a tree that close more than one loop, but few. At bifurcation points, steps in
/// angles err by less for a single loop and for the many of lazy tongs, which fold at once.
const ROWS_OF_FEW_LOOPS: std::ops::RangeInclusive<usize> = 3..=6;

/// The bodies of a group as a tree, with its buffers. Without links there is no tree, and the group is stepped in the
/// coordinates of its bodies.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct JointTree {
    /// Parents come before their children.
    links: Vec<Link>,
    numbers: Numbers,
    /// Rows of the group that are those of the tree's pins.
    hung: Vec<usize>,
    loop_rows: LoopRows,
    stances: Vec<Stance>,
    bundles: Vec<Bundle>,
    /// Coordinates, their velocities, and works, at the start of a step.
    state: Vec<f64>,
    /// Rates of `state`.
    rates: Vec<f64>,
    /// Coordinates, their velocities, and works, at the end of a step.
    end: Vec<f64>,
    /// Rates of `end`.
    end_rates: Vec<f64>,
    /// Dense output of the coordinates.
    angles: Vec<SegmentPolynomial>,
    /// Dense output of the velocities of the coordinates, then of the works.
    velocities: Vec<SegmentPolynomial>,
    /// Positions of bodies at the inner nodes.
    inner: Vec<[DVec2; SegmentPolynomial::INNER.len()]>,
    /// Index of the link of each body of the group; `None` while it has none.
    link_of: Vec<Option<usize>>,
    /// The group is stepped in the coordinates of its bodies for now, although there is a tree.
    is_bypassed: bool,
}

impl JointTree {
    /// Indices in the group of the rows beside its pins.
    pub(super) fn rows_beside(&self) -> impl Iterator<Item = usize> + '_ {
        self.loop_rows.rows.iter().copied()
    }

    pub(crate) fn clear(&mut self) {
        self.links.clear();
        self.numbers.0.clear();
        self.loop_rows.rows.clear();
        self.is_bypassed = false;
    }

    /// Has the group stepped in the coordinates of its bodies from now on; true if it was stepped as a tree.
    pub(crate) fn bypass(&mut self) -> bool {
        let was_used = self.is_used();
        self.is_bypassed = self.exists();
        was_used
    }

    /// Has the group stepped as a tree again, if there is one; true if it was bypassed.
    pub(crate) fn use_again(&mut self) -> bool {
        std::mem::take(&mut self.is_bypassed)
    }

    /// True if there is a tree, whether the group is stepped as one or not.
    pub(crate) fn exists(&self) -> bool {
        !self.links.is_empty()
    }

    /// True if there is a tree, but the group is stepped in the coordinates of its bodies for now.
    pub(crate) fn is_bypassed(&self) -> bool {
        self.is_bypassed
    }

    /// True if the group is stepped as a tree.
    #[inline]
    pub(crate) fn is_used(&self) -> bool {
        self.exists() && !self.is_bypassed
    }

    /// True if the group is stepped as a tree and has no rows beside its pins: its coordinates keep to all rows.
    pub(crate) fn holds_all(&self) -> bool {
        self.is_used() && self.loop_rows.rows.is_empty()
    }

    /// True if the rows beside its pins close more than one loop, but few.
    pub(crate) fn has_few_loops(&self) -> bool {
        ROWS_OF_FEW_LOOPS.contains(&self.loop_rows.rows.len())
    }

    /// Number of coordinates.
    pub(crate) fn count(&self) -> usize {
        self.numbers.0.len()
    }
}
