//! Displacements that bring bodies which overlap back to their gaps: the least in the metric of the masses, found by sweeps. Connectors keep
//! together what they have; the velocities of a step bring back what has come apart.

use crate::stepping::bodies::{Bodies, Motion3, farthest};
use crate::stepping::books::StepBooks;
use crate::stepping::pairs::Pairs;
use crate::stepping::passing::FAST;
use crate::stepping::rows::{Mover, Row};
use halfgap_collision::BodyId;

/// Largest number of sweeps: what they leave is brought back in the next step.
const MOST_SWEEPS: usize = 10;
/// Share of the error that does not matter, up to which a sweep need not change anything [-].
const ENOUGH: f64 = 0.5;

/// Displacements at the start of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Shifts {
    movers: Vec<Mover>,
    /// Sum of the changes of the gaps of each body [m].
    changes: Vec<f64>,
    asked: Vec<u32>,
}

impl Shifts {
    /// Finds displacements that bring rows back which are off by more than a slack [m]; the gaps of the rows are then those after them.
    pub(super) fn find(&mut self, bodies: &Bodies, rows: &mut [Row], slack: f64) {
        let Self { movers, changes, asked } = self;
        movers.clear();
        movers.extend((0..=bodies.count()).map(|place| bodies.mover(place, [0.0; 3])));
        changes.clear();
        changes.resize(movers.len(), 0.0);
        let enough = ENOUGH * slack;
        asked.clear();
        for (index, row) in rows.iter_mut().enumerate() {
            row.normal.before = 0.0;
            if !row.is_bilateral && row.gap < 0.0 {
                asked.push(index as u32);
            }
        }
        for _ in 0..MOST_SWEEPS {
            let mut most = 0.0_f64;
            for &index in asked.iter() {
                most = most.max(visit(&mut rows[index as usize], movers, changes));
            }
            if most <= enough {
                break;
            }
            // Only what others have moved since is looked at again.
            asked.clear();
            let moved = |row: &Row| row.all_ends().any(|place| changes[place] > enough);
            asked.extend((0..rows.len()).filter(|&index| moved(&rows[index])).map(|index| index as u32));
        }
        for row in rows.iter_mut() {
            let [a, b] = row.ends();
            if row.all_ends().map(|place| changes[place]).sum::<f64>() > 0.0 {
                let [p, q] = [a, b].map(|place| &movers[place].velocity);
                row.gap += row.change_of(movers);
                row.slip.off += row.slip.line.rate(p, q);
            }
        }
    }

    /// Shifts the bodies, but lifts nothing by more energy than contacts have taken since they sank, and pushes nothing through what is near.
    pub(super) fn apply(&mut self, bodies: &mut Bodies, pairs: &Pairs, books: &mut StepBooks) {
        for (place, mover) in self.movers.iter_mut().enumerate().take(bodies.count()) {
            let way = farthest(bodies.natures[place].reach, mover.velocity);
            if way > FAST * bodies.least_thickness {
                let near =
                    pairs.of(BodyId::from_index(place)).iter().map(|&pair| pairs.all()[pair as usize].bodies);
                let thinnest = near
                    .map(|pair| bodies.thinner(pair.map(BodyId::index)))
                    .fold(bodies.natures[place].thickness, f64::min);
                let share = (FAST * thinnest / way).min(1.0);
                mover.velocity = mover.velocity.map(|shift| share * shift);
            }
        }
        let lifts: f64 =
            (0..bodies.count()).map(|place| lift(bodies, place, self.movers[place].velocity)).sum();
        let share = if lifts > books.spare() { books.spare() / lifts } else { 1.0 };
        for (place, mover) in self.movers.iter().enumerate().take(bodies.count()) {
            let shift = mover.velocity.map(|shift| share * shift);
            if shift != [0.0; 3] {
                books.book_projection(lift(bodies, place, shift));
                bodies.shift(place, shift);
            }
        }
    }
}

/// Energy [J] that a shift of a body takes against the force that acts on it everywhere.
fn lift(bodies: &Bodies, place: usize, [x, y, _]: Motion3) -> f64 {
    let nature = &bodies.natures[place];
    let acceleration = nature.free_motion.acceleration;
    if nature.body.is_fixed() {
        0.0
    } else {
        -(acceleration.x * x + acceleration.y * y) / nature.body.inverse_mass
    }
}

/// Gives a row the displacement by which its gap is none, or none if it is open, and that by which a connector stays as it is; returns the change of the gap [m].
fn visit(row: &mut Row, shifts: &mut [Mover], changes: &mut [f64]) -> f64 {
    let lacking = row.change_of(shifts) + if row.is_bilateral { 0.0 } else { row.gap };
    let before = row.normal.before;
    let wanted = before - lacking * row.normal.weight;
    let impulse = if row.is_bilateral { wanted } else { wanted.max(0.0) } - before;
    if impulse == 0.0 {
        return 0.0;
    }
    row.push(shifts, impulse);
    row.normal.before += impulse;
    let change = impulse.abs() * row.normal.compliance;
    row.all_ends().for_each(|place| changes[place] += change);
    change
}
