//! The number of blows that an impact may take before it counts as a ricochet without end (see `patience`).
//!
//! A light body of mass m between a heavy one of mass M and a wall turns the heavy one round by pi / atan(sqrt(m / M))
//! small blows, which all count (G. Galperin, "Playing pool with pi", Regular and Chaotic Dynamics 8, 2003, 375-394); a
//! line of n light ones takes about n times as many. Each row is given that many blows, but not in impacts with
//! connectors, which may pass impulses round for ever.
//!
//! A body between two walls at a small angle a is turned back by pi / a blows, whatever its mass: a die that jams in
//! its slot. Impacts of a few contacts are given as many as an angle of a few degrees takes, with connectors or without.
//! Without connectors a blow costs next to nothing, and there are as many as the least angle takes, but where walls are so
//! nearly parallel that the body would go to and fro for ever.

use super::Impact;
use crate::row::CollisionRow;
use std::f64::consts::PI;

/// Largest number of blows by which a light body turns a heavy one round, times the root of the ratio of their masses:
/// pi/atan(x) <= 4/x.
const BLOWS_OF_MASSES: f64 = 4.0;
/// Cap on the number of blows: that of a mass ratio of about 1e9, or of an angle of 3e-5 rad.
const MOST_BLOWS: f64 = 1e5;
/// Largest number of rebounding contacts that count as few.
const FEW_CONTACTS: usize = 4;
/// Number of blows that each row of an impact of few rebounding contacts may take.
const BLOWS_OF_FEW: f64 = 200.0;
/// Number of blows of each row, times the least angle [rad] between walls: each of two rows needs half of it.
const BLOWS_OF_ANGLE: f64 = PI;

impl Impact {
    /// Number of blows that each row may take.
    pub(super) fn blows(&self) -> usize {
        let rebounding = || self.rows.iter().filter(|row| !row.is_bilateral() && row.elasticity > 0.0);
        let of_few = match rebounding().count() {
            1..=FEW_CONTACTS => self.blows_of_angles(),
            _ => 0.0,
        };
        (BLOWS_OF_MASSES / self.lightness().sqrt()).min(MOST_BLOWS).max(of_few) as usize
    }

    /// Whether the rows are a few contacts and nothing else.
    pub(super) fn has_few_contacts(&self) -> bool {
        !self.has_connectors && self.rows.len() <= FEW_CONTACTS
    }

    /// Number of blows that the least angle between rows takes which drive each other together.
    fn blows_of_angles(&self) -> f64 {
        if !self.has_few_contacts() {
            return BLOWS_OF_FEW;
        }
        let least_cosine = |(at, row): (usize, &CollisionRow)| {
            let others = self.rows[..at].iter();
            let cosine = |other: &CollisionRow| {
                let squares = row.coupling(row) * other.coupling(other);
                if squares > 0.0 { row.coupling(other) / squares.sqrt() } else { 0.0 }
            };
            others.map(cosine).fold(0.0, f64::min)
        };
        let cosine = self.rows.iter().enumerate().map(least_cosine).fold(0.0, f64::min);
        let blows = BLOWS_OF_ANGLE / (-cosine).min(1.0).acos();
        if blows <= MOST_BLOWS { blows.max(BLOWS_OF_FEW) } else { BLOWS_OF_FEW }
    }

    /// Ratio [-] of the least to the greatest mass of a body, as seen along the rows that rebound; 1 if there are
    /// connectors.
    fn lightness(&self) -> f64 {
        if self.has_connectors {
            return 1.0;
        }
        let rebounding = || self.rows.iter().filter(|row| row.elasticity > 0.0);
        let shares = || rebounding().flat_map(CollisionRow::shares).filter(|share| *share > 0.0);
        let (least, most) = (shares().fold(f64::INFINITY, f64::min), shares().fold(0.0, f64::max));
        if most > 0.0 { least / most } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::InverseInertia;
    use halfgap_collision::BodyId;

    /// An impact of a disc of 1 kg with elastic planes whose normals have these directions [rad].
    fn between(directions: &[f64]) -> Impact {
        let inertia =
            [1.0, 0.0].map(|inverse| InverseInertia { inverse_mass: inverse, inverse_moment: inverse });
        let mut impact = Impact::new();
        impact.set_rows(directions.iter().map(|direction| {
            let (sin, cos) = direction.sin_cos();
            let row = [cos, sin, 0.0, -cos, -sin, 0.0];
            CollisionRow {
                elasticity: 1.0,
                ..CollisionRow::new([BodyId(0), BodyId::WORLD], row, inertia, -cos)
            }
        }));
        impact
    }

    #[test]
    fn a_body_between_two_planes_is_given_as_many_blows_as_turn_it_back() {
        for angle in [0.1, 1e-3, 1e-4] {
            let needed = (PI / angle).ceil() as usize;
            let blows = between(&[0.0, PI - angle]).blows();
            assert!((needed / 2..=needed.max(200)).contains(&blows), "{angle}: {blows} of each row");
        }
        // Planes that face each other, or the same way, and nearly so.
        for angle in [PI, PI - 1e-9, 0.0, 1e-3] {
            assert_eq!(between(&[0.0, angle]).blows(), 200, "{angle}");
        }
        assert_eq!(between(&[0.0; 5]).blows(), 4);
    }

    #[test]
    fn an_elastic_disc_between_two_planes_keeps_its_energy() {
        use crate::{ImpactLaw, ImpactOrder};
        // The disc moves at 1 m/s from one plane to the other, and is driven out of the wedge.
        for angle in [0.1, 1e-2, 1e-3, 1e-4] {
            let mut impact = between(&[-0.5 * angle, PI + 0.5 * angle]);
            ImpactLaw::Hybrid.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("an answer");
            let [p, q] = impact.impulses() else { panic!("two rows") };
            let (sin, cos) = (0.5 * angle).sin_cos();
            let (across, along) = ((p - q) * cos - 1.0, (p + q) * sin);
            let energy = across * across + along * along;
            assert!((energy - 1.0).abs() < 1e-7, "{angle}: {energy} of 1");
            assert!(impact.rates().iter().all(|rate| *rate >= -1e-9), "{angle}: {:?}", impact.rates());
        }
    }
}
