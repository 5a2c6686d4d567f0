//! What drives, motors, moved bodies and dry friction in joints do, in the books.
//!
//! *Invariant*: what is booked here is taken from what rows did in all, so that the sum of the accounts does not change.

use crate::stepping::bodies::{Bodies, Motion3};
use crate::stepping::books::{Driven, StepBooks};
use crate::stepping::rows::Row;
use crate::stepping::step::Stepper;

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
            if !row.touches {
                continue;
            }
            let impulses = [row.normal.impulse, row.slip.line.impulse].map(|impulse| share * impulse);
            row.drive(impulses, (bodies, &self.means), &mut driven);
            if let Some(roll) = row.roll {
                let line = &self.rows.rolls[roll as usize].line;
                driven.drives -=
                    share * line.impulse * row.rate_of_fixed(line.jacobian(), bodies, &self.means);
            }
        }
        books.book_driven(driven, span, is_present);
    }
}

impl Row {
    /// Adds what the row does with impulses along its normal and along the surface, at given velocities.
    pub(super) fn drive(
        &self,
        [normal, slip]: [f64; 2],
        (bodies, velocities): (&Bodies, &[Motion3]),
        driven: &mut Driven,
    ) {
        if self.prescribed.is_some() {
            driven.drives += normal * self.change(velocities);
        } else if self.pulls() {
            driven.rubbing += normal * self.change(velocities);
        }
        let third = self.third().map(|third| (third.place as usize, third.arm));
        let of_third = third.filter(|&(place, _)| is_moved(bodies, place));
        let of_third = of_third.map_or(0.0, |(place, arm)| arm * velocities[place][2]);
        driven.drives -= normal * (self.rate_of_fixed(self.jacobian(), bodies, velocities) + of_third);
        driven.drives -= slip * self.rate_of_fixed(self.slip.line.jacobian(), bodies, velocities);
    }

    /// The same of an impact that leads from velocities to others.
    pub(super) fn drive_blow(
        &self,
        blows: [f64; 2],
        bodies: &Bodies,
        velocities: [&[Motion3]; 2],
        driven: &mut Driven,
    ) {
        for velocities in velocities {
            self.drive(blows.map(|blow| 0.5 * blow), (bodies, velocities), driven);
        }
    }

    /// The part of J v [m/s] of its first two bodies that is due to fixed ones, which are moved.
    fn rate_of_fixed(&self, jacobian: [f64; 6], bodies: &Bodies, velocities: &[Motion3]) -> f64 {
        let sides = self.ends().into_iter().zip(jacobian.as_chunks::<3>().0);
        let rates = sides.filter(|&(place, _)| is_moved(bodies, place)).map(|(place, [x, y, turn])| {
            let [u, v, spin] = velocities[place];
            x * u + y * v + turn * spin
        });
        rates.sum()
    }
}

/// True for a body that no force moves; it may be moved.
fn is_moved(bodies: &Bodies, place: usize) -> bool {
    place < bodies.count() && bodies.natures[place].body.is_fixed()
}
