//! What drives, motors, moved bodies and dry friction in joints do, in the books.
//!
//! *Invariant*: what is booked here is taken from what rows did in all, so that the sum of the accounts does not change.

use crate::stepping::bodies::{Bodies, Motion3};
use crate::stepping::books::StepBooks;
use crate::stepping::rows::{Roll, Row};
use crate::stepping::step::Stepper;

/// Work [J] of the rows of an island on bodies that can move.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Driven {
    /// By drives, motors and bodies that are moved.
    pub(super) drives: f64,
    /// By dry friction in joints: the heat, negative.
    pub(super) rubbing: f64,
}

impl Stepper {
    /// True if something drives, or rubs in a joint, in the present step.
    pub(super) fn is_driven(&self, bodies: &Bodies) -> bool {
        let mut all = bodies.natures.iter().zip(&bodies.courses);
        self.rows.drives || all.any(|(nature, course)| nature.body.is_fixed() && course.middle != [0.0; 3])
    }

    /// Books what drives an island in a time `span` [s], given the share in it of the impulses that rows have, at the velocities in `means`.
    pub(super) fn book_driven(
        &self,
        bodies: &Bodies,
        (island, share): (usize, f64),
        (span, is_present): (f64, bool),
        books: &mut StepBooks,
    ) {
        if !self.is_driven {
            return;
        }
        let mut driven = Driven::default();
        let (_, list) = self.islands.get(island);
        for &row in list {
            let row = &self.rows.all[row as usize];
            let roll = row.roll.map(|roll| &self.rows.rolls[roll as usize]);
            if row.touches {
                row.drive(roll, (bodies, &self.means), share, &mut driven);
            }
        }
        books.book_driven(driven, span, is_present);
    }
}

impl Row {
    /// Adds what the row and its resistance against rolling do with a share of their impulses at given velocities.
    fn drive(
        &self,
        roll: Option<&Roll>,
        (bodies, velocities): (&Bodies, &[Motion3]),
        share: f64,
        driven: &mut Driven,
    ) {
        let impulse = share * self.normal.impulse;
        if self.prescribed.is_some() {
            driven.drives += impulse * self.change(velocities);
        } else if self.pulls() {
            driven.rubbing += impulse * self.change(velocities);
        }
        let is_moved = |place: usize| place < bodies.count() && bodies.natures[place].body.is_fixed();
        let ends = self.ends();
        if !self.all_ends().any(is_moved) {
            return;
        }
        let on_moved = |jacobian: [f64; 6]| {
            let sides = ends.into_iter().zip(jacobian.as_chunks::<3>().0);
            let rates = sides.filter(|&(place, _)| is_moved(place)).map(|(place, [x, y, turn])| {
                let [u, v, spin] = velocities[place];
                x * u + y * v + turn * spin
            });
            rates.sum::<f64>()
        };
        let third = self.third().map(|third| (third.place as usize, third.arm));
        let of_third = third.filter(|&(place, _)| is_moved(place));
        let of_third = of_third.map_or(0.0, |(place, arm)| arm * velocities[place][2]);
        driven.drives -= impulse * (on_moved(self.jacobian()) + of_third);
        for line in [Some(&self.slip.line), roll.map(|roll| &roll.line)].into_iter().flatten() {
            driven.drives -= share * line.impulse * on_moved(line.jacobian());
        }
    }
}
