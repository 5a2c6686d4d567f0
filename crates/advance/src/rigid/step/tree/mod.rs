//! Bodies that hang on each other by pins, as a tree: their motion in as many coordinates as they have freedoms.
//!
//! Where a group is held by pins that close no loop, a state of angles, and of positions of those bodies that
//! hang on nothing, says where everything is. Steps in these coordinates keep to the pins by themselves, have
//! a third of the numbers, and their accelerations follow from one sweep from the tips to the roots and one
//! back, without any system of equations but for a few rows beside the pins. All other rooms go on with
//! bodies: this one translates at both ends of a step, and its dense output.
//!
//! `build` finds the tree, `placing` goes from coordinates to bodies, `sweeps` finds accelerations, `rest`
//! holds what is held beside the pins, `stepping` makes the steps of a group, `forces` tells what its rows
//! give. Angles are those of the bodies, not those between them, so a coordinate of the tree is a number of
//! the group's state.

mod build;
mod forces;
mod placing;
mod rest;
mod stepping;
mod sweeps;
#[cfg(test)]
mod tests;

use crate::ode::SegmentPolynomial;
use glam::DVec2;
use rest::Rest;
use sweeps::Bundle;

/// What a body of a tree hangs on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Hinge {
    /// Nothing: its position counts among the coordinates.
    Free,
    /// A point [m] of the world.
    World(DVec2),
    /// Another body, which comes earlier in the tree.
    Link {
        /// Place of that body in the tree.
        parent: usize,
        /// The pin [m] in that body's coordinates.
        arm: DVec2,
        /// Where this body has the pin, as seen from there [m]: what the pin's gap was when it formed.
        offset: DVec2,
    },
}

/// A body of a tree, with what it hangs on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Link {
    /// Its place in the group.
    place: usize,
    hinge: Hinge,
    /// Its own pin [m] in its coordinates, zero if it is free.
    own: DVec2,
    /// [kg]
    mass: f64,
    /// About the centre of mass [kg m^2].
    moment: f64,
    /// The largest angle [rad] by which it may turn in a step.
    most_turn: f64,
    /// Sum over all bodies of the squares of the distances [m] by which they move as this one turns by a
    /// radian; its own points count by its reach.
    lever_square: f64,
    /// How many bodies hang on it, by whatever others.
    descendants: usize,
}

/// How a body stands in the world, as far as its equations need it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Stance {
    /// From its centre of mass to its own pin [m].
    own: DVec2,
    /// From its parent's own pin to the pin between them [m].
    of_parent: DVec2,
    /// Square of its angular velocity [rad^2/s^2].
    spin_square: f64,
}

/// Which number of a group's positions each coordinate is: link by link, the angle, then the position of a free one.
#[derive(Clone, Debug, Default)]
struct Numbers(Vec<usize>);

/// Rows beside the pins of a tree that close more than one loop, but few. Where one folds, or the many of lazy tongs at
/// once, steps in angles err by less.
const ROWS_OF_FEW_LOOPS: std::ops::RangeInclusive<usize> = 3..=6;

/// The bodies of a group as a tree, with its buffers. Without links there is none, and the group is stepped as it is.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointTree {
    /// Parents come before their children.
    links: Vec<Link>,
    numbers: Numbers,
    /// Rows of the group whose pins the tree hangs by.
    hung: Vec<usize>,
    rest: Rest,
    stances: Vec<Stance>,
    bundles: Vec<Bundle>,
    /// Coordinates, their rates, and works: at the start of a step, and at its end.
    state: Vec<f64>,
    rates: Vec<f64>,
    end: Vec<f64>,
    end_rates: Vec<f64>,
    /// Dense output of the coordinates, and of their rates and the works.
    angles: Vec<SegmentPolynomial>,
    velocities: Vec<SegmentPolynomial>,
    /// Positions of bodies at the inner nodes.
    inner: Vec<[DVec2; SegmentPolynomial::INNER.len()]>,
    /// Link of each body of the group.
    link_of: Vec<Option<usize>>,
    /// The group is stepped as it is for now, although there is a tree.
    is_bypassed: bool,
}

impl JointTree {
    pub(crate) fn clear(&mut self) {
        self.links.clear();
        self.numbers.0.clear();
        self.rest.rows.clear();
        self.is_bypassed = false;
    }

    /// Lets the group be stepped as it is from now on; true if it was stepped as a tree.
    pub(crate) fn bypass(&mut self) -> bool {
        let was_used = self.is_used();
        self.is_bypassed = self.exists();
        was_used
    }

    /// Lets the group be stepped as a tree again; true if it was not.
    pub(crate) fn use_again(&mut self) -> bool {
        std::mem::take(&mut self.is_bypassed)
    }

    /// True if there is a tree, whether the group is stepped as one or not.
    pub(crate) fn exists(&self) -> bool {
        !self.links.is_empty()
    }

    /// True if there is a tree, but the group is stepped as it is for now.
    pub(crate) fn is_bypassed(&self) -> bool {
        self.is_bypassed
    }

    /// True if the group is stepped as a tree.
    #[inline]
    pub(crate) fn is_used(&self) -> bool {
        self.exists() && !self.is_bypassed
    }

    /// True if bodies that are where its coordinates say are where all rows hold them.
    pub(crate) fn holds_all(&self) -> bool {
        self.is_used() && self.rest.rows.is_empty()
    }

    /// True if it has more than one loop, but few.
    pub(crate) fn has_few_loops(&self) -> bool {
        ROWS_OF_FEW_LOOPS.contains(&self.rest.rows.len())
    }

    /// Coordinates.
    pub(crate) fn count(&self) -> usize {
        self.numbers.0.len()
    }
}
