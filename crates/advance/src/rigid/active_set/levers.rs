//! Levers: the part of a contact's row that connectors do not hold already.
//!
//! A contact beside the hinge of a lid acts on the lid by a lever that vanishes as the lid falls shut: its row is then
//! nearly a linear combination of the pin's rows. The rest of a row, in the metric of the masses, is found by
//! orthogonalising it against those rows, twice, which is exact to rounding of the row (W. Kahan and B. Parlett, in B.
//! Parlett, "The Symmetric Eigenvalue Problem", 1980, 6.9).

use crate::rigid::region::touching::Region;
use crate::rigid::shares::ROUNDED;
use halfgap_collision::{BodyId, Collision};
use halfgap_contact::InverseInertia;

/// Orthonormal basis of the rows of a region's connectors, in the metric of the masses.
#[derive(Clone, Debug, Default)]
pub(crate) struct Levers {
    /// The basis, row by row, with three entries for each body of the region.
    basis: Vec<f64>,
    row: Vec<f64>,
}

impl Levers {
    /// Builds the basis from the connectors of a region.
    pub(crate) fn load(&mut self, region: &Region, inertia: impl Fn(BodyId) -> InverseInertia) {
        self.basis.clear();
        for record in region.records().iter().filter(|record| record.parties.bilateral) {
            if self.left_of(region, record, &inertia) > ROUNDED {
                let square: f64 = self.row.iter().map(|entry| entry * entry).sum();
                self.basis.extend(self.row.iter().map(|entry| entry / square.sqrt()));
            }
        }
    }

    /// Fraction of a record's square that the connectors leave: the square of its lever relative to that without them.
    /// 0 if no body can move.
    pub(crate) fn left_of(
        &mut self,
        region: &Region,
        record: &Collision,
        inertia: impl Fn(BodyId) -> InverseInertia,
    ) -> f64 {
        let Self { basis, row } = self;
        row.clear();
        row.resize(3 * region.bodies().len(), 0.0);
        let j = &record.motion.kinematics.jacobian;
        for (side, body) in record.bodies().into_iter().enumerate() {
            let Some(place) = region.place(body) else { continue };
            let InverseInertia { inverse_mass, inverse_moment } = inertia(body);
            for (k, weight) in [inverse_mass, inverse_mass, inverse_moment].into_iter().enumerate() {
                row[3 * place + k] += weight.sqrt() * j[3 * side + k];
            }
        }
        if let Some((body, j)) = record.parties.third
            && let Some(place) = region.place(body)
        {
            row[3 * place + 2] += inertia(body).inverse_moment.sqrt() * j;
        }
        let square = |row: &[f64]| row.iter().map(|entry| entry * entry).sum::<f64>();
        let whole = square(row);
        for _ in 0..2 {
            for other in basis.chunks_exact(row.len().max(1)) {
                let share: f64 = row.iter().zip(other).map(|(p, q)| p * q).sum();
                row.iter_mut().zip(other).for_each(|(entry, q)| *entry -= share * q);
            }
        }
        if whole > 0.0 { square(row) / whole } else { 0.0 }
    }
}
