//! Third sides of rows: the angular velocity of one more body, with a coefficient that never changes, as that of the carrier of a gear.
//! They stand beside the two sides of all rows, in a list that is mostly empty, so that rows without them cost and give what they did.

use super::ActiveRows;
use crate::problem::InverseInertia;

/// The third side of a row, by which it measures the angular velocity of a body that is neither its primary nor its normal one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ThirdSide {
    /// Index of the row.
    pub row: u32,
    /// Index of the body.
    pub body: u32,
    /// Coefficient \[m\] of its angular velocity in the rate of the row.
    pub coefficient: f64,
}

/// A third side that can move.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Third {
    pub(super) place: usize,
    pub(super) body: u32,
    /// Root of the inverse moment of the body.
    root: f64,
    /// Entry of Ĵ = J M^(-1/2).
    pub(super) entry: f64,
}

/// A product of a third side with a side of another row.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Crossing {
    /// The other row's side: twice its place, plus 1 for the normal side.
    side: u32,
    entry: f64,
    position: u32,
}

/// The third sides of rows, and their products.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Thirds {
    /// In ascending order of place.
    all: Vec<Third>,
    crossings: Vec<Crossing>,
    /// Position and value of the products of third sides with each other.
    constants: Vec<(u32, f64)>,
}

impl Thirds {
    /// Forgets all third sides.
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.crossings.clear();
        self.constants.clear();
    }

    #[inline]
    pub(super) fn all(&self) -> &[Third] {
        &self.all
    }

    /// The third side of the row at a place.
    #[inline]
    pub(super) fn of(&self, place: usize) -> Option<&Third> {
        if self.all.is_empty() {
            return None;
        }
        self.all.binary_search_by_key(&place, |third| third.place).ok().map(|at| &self.all[at])
    }

    /// The first place with which the row at a place shares the body of a third side, of either row; its own if there is none before
    /// it. `bodies` has the two sides of each row.
    pub(super) fn first(&self, place: usize, bodies: &[[u32; 2]]) -> usize {
        if self.all.is_empty() {
            return place;
        }
        let own = self.of(place).map(|third| third.body);
        let by_own = own.and_then(|body| bodies[..place].iter().position(|sides| sides.contains(&body)));
        let shares = |third: &&Third| own == Some(third.body) || bodies[place].contains(&third.body);
        let by_other = self.all.iter().find(shares).map(|third| third.place);
        [by_own, by_other].into_iter().flatten().fold(place, usize::min)
    }

    /// Adds the products of third sides to the entries of A below the diagonal.
    pub(super) fn add_entries(&self, jacobian: &[[[f64; 3]; 2]], entries: &mut [f64]) {
        let sides = jacobian.as_flattened();
        for crossing in &self.crossings {
            entries[crossing.position as usize] += crossing.entry * sides[crossing.side as usize][2];
        }
        for &(position, product) in &self.constants {
            entries[position as usize] += product;
        }
    }
}

impl ActiveRows {
    /// Takes the third sides of rows whose order is known.
    pub(super) fn take_thirds(&mut self, inertia: &[InverseInertia], thirds: &[ThirdSide]) {
        self.thirds.clear();
        for third in thirds {
            let root = inertia[third.body as usize].inverse_moment.sqrt();
            let place = self.row_of.iter().position(|&row| row == third.row);
            let place = place.expect("a third side belongs to one of the rows");
            if root > 0.0 {
                let entry = root * third.coefficient;
                self.thirds.all.push(Third { place, body: third.body, root, entry });
            }
        }
        self.thirds.all.sort_unstable_by_key(|third| third.place);
    }

    /// Lists the products of third sides, with their positions in the factor.
    pub(super) fn list_crossings(&mut self) {
        let Self { thirds, bodies, factor, .. } = self;
        let position =
            |place: usize, other: usize| factor.position(place.max(other), place.min(other)) as u32;
        for (at, third) in thirds.all.iter().enumerate() {
            for (side, _) in bodies.as_flattened().iter().enumerate().filter(|(_, body)| **body == third.body)
            {
                let position = position(third.place, side / 2);
                thirds.crossings.push(Crossing { side: side as u32, entry: third.entry, position });
            }
            for other in thirds.all[..at].iter().filter(|other| other.body == third.body) {
                let position = position(third.place, other.place);
                thirds.constants.push((position, third.entry * other.entry));
            }
        }
    }

    /// The part of the square of a row that its third side has.
    #[inline]
    pub(super) fn third_square(&self, place: usize) -> f64 {
        self.thirds.of(place).map_or(0.0, |third| third.entry * third.entry)
    }

    /// Adds what forces on rows change of the accelerations of their third bodies.
    pub(super) fn respond_by_thirds(&self, force: &[f64], change: &mut [[f64; 3]]) {
        for third in &self.thirds.all {
            let push = force[self.row_of[third.place] as usize];
            change[third.body as usize][2] += third.root * third.entry * push;
        }
    }

    /// Adds the rates that third sides have by the turning of a body, in units of M^(1/2), to those of all rows.
    pub(super) fn add_third_rates(&self, body: u32, turning: f64, rates: &mut [f64]) {
        for third in self.thirds.all.iter().filter(|third| third.body == body) {
            rates[self.row_of[third.place] as usize] += turning * third.entry;
        }
    }
}
