//! Refinement of forces: of those of soft rows, which the raised squares leave too small, and of those that suffer from
//! rounding of the factor where little is left of a row. The parent module decides which rows are soft, and owns the
//! factor.

use super::{ActiveRows, NONE};
use crate::skyline::dot;

/// Cap on the refinement steps for soft rows.
const MOST_REFINEMENTS: usize = 40;
/// A direction p of forces moves nothing, and is one in which rows disagree, if pᵀ A p is at most this fraction of pᵀ R
/// p, R the raise of the squares.
const NULL: f64 = 1e-7;
/// Number of refinement steps without a gain in succession that ends the refinement.
const IDLE: u32 = 2;
/// Fraction of the least residual so far: a step gains if it leaves less, as the largest rate or in the norm of the
/// raised factor. The largest rate alone may grow on the way: most of the square of a row of a light disc on a long arm
/// is the turning of the disc, whose residual is small long before that of the rest.
const WORTHWHILE: f64 = 0.5;

/// Buffers of a refinement, one number per row.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Refining {
    /// Residual A f + b of the forces.
    residual: Vec<f64>,
    /// Correction of the forces by the raised factor: -(A + R)⁻¹ times the residual.
    lacking: Vec<f64>,
    direction: Vec<f64>,
    /// A times the direction.
    product: Vec<f64>,
    /// The forces with the least residual so far.
    best: Vec<f64>,
}

impl ActiveRows {
    /// Refines the forces by conjugate gradients, preconditioned by the raised factor. It differs from A in few
    /// directions, each of which takes about a step. A disagreement of rows that depend on each other cannot be
    /// removed; the forces with the least residual are kept.
    pub(super) fn refine(&mut self, offset: &[f64], force: &mut [f64], refining: &mut Refining) {
        let Refining { residual, lacking, direction, product, best } = refining;
        for buffer in [&mut *residual, lacking, direction, product, best] {
            buffer.clear();
            buffer.resize(force.len(), 0.0);
        }
        self.measure_residual(offset, force, residual);
        best.copy_from_slice(force);
        let (mut least, mut before) = (largest(residual), f64::INFINITY);
        let enough = f64::EPSILON * largest(offset);
        let (mut idle, mut least_descent) = (0, f64::INFINITY);
        for _ in 0..MOST_REFINEMENTS {
            if least <= enough || idle == IDLE {
                break;
            }
            self.solve_raised(residual, lacking);
            let descent = -dot(residual, lacking);
            let descends = descent < WORTHWHILE * least_descent;
            least_descent = least_descent.min(descent);
            let keep = descent / before;
            direction.iter_mut().zip(&*lacking).for_each(|(p, z)| *p = z + keep * *p);
            self.multiply(direction, product);
            let square = dot(direction, product);
            let does_little = square <= NULL * self.softness_of(direction);
            if does_little {
                // Along a direction in which rows disagree forces would grow without bound; a plain correction is made
                // instead.
                direction.copy_from_slice(lacking);
            }
            let step = if does_little { 1.0 } else { descent / square };
            before = if does_little { f64::INFINITY } else { descent };
            force.iter_mut().zip(&*direction).for_each(|(f, p)| *f += step * p);
            self.measure_residual(offset, force, residual);
            let left = largest(residual);
            idle = if descends || left < WORTHWHILE * least { 0 } else { idle + 1 };
            if left < least {
                least = left;
                best.copy_from_slice(force);
            }
        }
        force.copy_from_slice(best);
    }

    /// Makes one step of iterative refinement.
    pub(super) fn correct(&mut self, offset: &[f64], force: &mut [f64], refining: &mut Refining) {
        let Refining { residual, lacking, .. } = refining;
        for buffer in [&mut *residual, lacking] {
            buffer.clear();
            buffer.resize(force.len(), 0.0);
        }
        self.measure_residual(offset, force, residual);
        self.solve_raised(residual, lacking);
        force.iter_mut().zip(&*lacking).for_each(|(force, lacking)| *force += lacking);
    }

    /// f R f, R the raise of the squares of soft rows.
    fn softness_of(&self, force: &[f64]) -> f64 {
        let soft = self.raise.iter().enumerate().filter(|(_, raise)| **raise > 0.0);
        let part = |(place, raise): (usize, &f64)| {
            let force = force[self.row_of[place] as usize];
            force * force * raise * self.square(place)
        };
        soft.map(part).sum()
    }

    /// A f + b of each row.
    fn measure_residual(&mut self, offset: &[f64], force: &[f64], residual: &mut [f64]) {
        self.multiply(force, residual);
        residual.iter_mut().zip(offset).for_each(|(residual, offset)| *residual += offset);
    }

    /// A f of each row.
    fn multiply(&mut self, force: &[f64], product: &mut [f64]) {
        self.motion.fill([0.0; 3]);
        for place in 0..self.root.len() {
            self.push(place, force[self.row_of[place] as usize]);
        }
        for ((bodies, sides), &index) in self.bodies.iter().zip(&self.jacobian).zip(&self.row_of) {
            let of_side = |(&body, row): (&u32, &[f64; 3])| {
                let motion = &self.motion[body as usize];
                (0..3).map(|k| row[k] * motion[k]).sum::<f64>()
            };
            let sides = bodies.iter().zip(sides).filter(|(body, _)| **body != NONE);
            product[index as usize] = sides.map(of_side).sum();
        }
        for third in self.thirds.all() {
            let turning = self.motion[third.body as usize][2];
            product[self.row_of[third.place] as usize] += third.entry * turning;
        }
    }
}

/// The largest absolute value.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::InverseInertia;

    #[test]
    fn a_light_body_passes_on_what_a_heavy_one_weighs_to_rounding() {
        // A light body on two contacts and a heavy one on it, with several roundings of their arms.
        let inertia = |mass: f64| InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 6.0 / mass };
        let sides = [[Some(0), None], [Some(0), None], [Some(1), Some(0)], [Some(1), Some(0)]];
        for heavy in [1e5, 1e6, 1e9] {
            for arm in [0.5, 1.0 / 3.0, 0.7, 0.123] {
                let rows: Vec<[f64; 6]> = [-arm, 1.1 * arm]
                    .iter()
                    .map(|&at| [0.0, 1.0, at, 0.0, 0.0, 0.0])
                    .chain([-0.9 * arm, arm].iter().map(|&at| [0.0, 1.0, at, 0.0, -1.0, -at]))
                    .collect();
                let mut active = ActiveRows::default();
                active.set_structure(&[inertia(1.0), inertia(heavy)], &sides);
                assert_eq!(active.factorize(&rows), 0);
                let offset: Vec<f64> = rows.iter().map(|row| -9.81 * (row[1] + row[4])).collect();
                let mut force = [0.0; 4];
                active.solve(&offset, &mut force);
                let weight = 9.81 * heavy;
                let off = |sum: f64, weight: f64| (sum / weight - 1.0).abs();
                let errors = [off(force[2] + force[3], weight), off(force[0] + force[1], weight + 9.81)];
                assert!(errors.iter().all(|error| *error < 1e-13), "{heavy:e}, {arm}: {errors:?}");
            }
        }
    }

    #[test]
    fn a_light_disc_on_two_long_arms_is_held_to_rounding() {
        // Nearly all of each row's square comes from the turning of the disc; the raise by softness exceeds all the
        // rest.
        let (block, disc) = (
            InverseInertia { inverse_mass: 0.505, inverse_moment: 2.448 },
            InverseInertia { inverse_mass: 0.748, inverse_moment: 394_127.0 },
        );
        let pin =
            |[x, y]: [f64; 2], [p, q]: [f64; 2]| [[1.0, 0.0, -y, -1.0, 0.0, q], [0.0, 1.0, x, 0.0, -1.0, -p]];
        // The vector from one pin to the other is the same on both bodies.
        let (on_block, on_disc) = ([0.309_894_089, 0.395_786], [7.810_749_75, 7.251_746_6]);
        let between = [-0.846_013_7, -0.525_505_3];
        let second = |first: [f64; 2]| [first[0] + between[0], first[1] + between[1]];
        let pins = [pin(on_block, on_disc), pin(second(on_block), second(on_disc))];
        let rows: Vec<[f64; 6]> = pins.into_iter().flatten().collect();
        let mut active = ActiveRows::default();
        active.set_structure(&[block, disc], &[[Some(0), Some(1)]; 4]);
        assert_eq!(active.factorize(&rows), 1);
        active.soften(|_| true);
        assert_eq!(active.factorize(&rows), 0);
        // The disc turns fast.
        let motion = [0.0, 0.0, 0.0, 5.9, -7.0, -71828.6];
        let rate = |row: &[f64; 6], motion: &[f64]| row.iter().zip(motion).map(|(j, v)| j * v).sum::<f64>();
        let offset: Vec<f64> = rows.iter().map(|row| rate(row, &motion)).collect();
        let mut force = [0.0; 4];
        active.solve(&offset, &mut force);
        let mut change = [[0.0; 3]; 2];
        active.respond(&force, &mut change);
        let left = rows.iter().zip(&offset).map(|(row, offset)| rate(row, change.as_flattened()) + offset);
        let left: Vec<f64> = left.collect();
        assert!(largest(&left) < 1e-11 * largest(&offset), "{left:?} of {offset:?}");
    }
}
