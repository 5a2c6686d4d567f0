//! Light bodies between heavy ones.
//!
//! The force that a heavy body exerts passes through the light ones below it, whose own weight is the difference of
//! forces that are larger by the ratio of the masses: beyond what numbers hold, the forces that are found do not
//! belong to the scene. A light body on a heavy one, or in its way, is no such case.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::error::AdvanceError;
use crate::time::Time;
use halfgap_collision::BodyId;
use std::iter::successors;

/// Largest ratio of the mass of a body to that of a lighter one through which it presses or pulls on another. Measured
/// with boxes and discs stacked on a floor, and with a bob on a light link, for 5 s at a tolerance of 1e-8: up to 1e9
/// all stay in place to 2e-10 m, at 1e10 some creep by 3e-7 m, at 1e11 by 1e-4 m or come to no end, and at 1e12 most
/// find no forces. Where no forces or impulses are found, a larger ratio is the reason.
pub const LARGEST_MASS_RATIO: f64 = 1e10;
/// Ratio of masses from which rows are refused though forces were found: those are rounding. With a tenth of it, three
/// of 5,000 generated scenes would be stopped that come to their end.
pub(crate) const HOPELESS_MASS_RATIO: f64 = 1e12;

impl Assembly {
    /// True if some masses are so different that bodies may be squeezed.
    pub(crate) fn has_extreme_masses(&self) -> bool {
        let masses = || {
            self.trajectories
                .iter()
                .map(|trajectory| trajectory.body().inverse_mass)
                .filter(|&inverse| inverse > 0.0)
        };
        masses().fold(0.0, f64::max) > LARGEST_MASS_RATIO * masses().fold(f64::INFINITY, f64::min)
    }

    /// Refuses rows between the given pairs of bodies that hold a body between one that is more than `ratio` times
    /// heavier and another.
    ///
    /// # Errors
    /// [`AdvanceError::Squeezed`].
    pub(crate) fn refuse_squeezed(
        &self,
        rows: impl Iterator<Item = [BodyId; 2]>,
        ratio: f64,
        time: Time,
    ) -> Result<(), AdvanceError> {
        if !self.masses_are_extreme {
            return Ok(());
        }
        let mut rows: Vec<_> = rows.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        rows.sort_unstable();
        rows.dedup();
        let mass = |body: BodyId| self.inertia(body).inverse_mass.recip();
        let Some([light, heavy]) = squeezed(&rows, ratio, mass) else { return Ok(()) };
        let masses = [light, heavy].map(mass);
        Err(AdvanceError::Squeezed { time: time.seconds(), light, heavy, masses })
    }
}

/// Returns a light body and a heavy one, from which rows lead through light bodies alone to a body that is not light:
/// the lightest on that way. The mass of a fixed body is infinite.
pub(crate) fn squeezed(
    rows: &[[BodyId; 2]],
    ratio: f64,
    mass: impl Fn(BodyId) -> f64,
) -> Option<[BodyId; 2]> {
    let mut movable: Vec<_> = rows.iter().flatten().copied().filter(|&body| mass(body).is_finite()).collect();
    movable.sort_unstable();
    movable.dedup();
    let least = movable.iter().map(|&body| mass(body)).fold(f64::INFINITY, f64::min);
    let heavy = movable.into_iter().filter(|&body| mass(body) > ratio * least);
    heavy.into_iter().find_map(|heavy| {
        let is_light = |body: BodyId| mass(body) * ratio < mass(heavy);
        let mut reached = vec![heavy];
        // For each, the place in `reached` of the body from which it was reached.
        let mut came_from = vec![0];
        let mut place = 0;
        while let Some(&body) = reached.get(place) {
            for others in rows.iter().filter(|row| row.contains(&body)) {
                let other = if others[0] == body { others[1] } else { others[0] };
                if is_light(other) && !reached.contains(&other) {
                    reached.push(other);
                    came_from.push(place);
                } else if place > 0 && !is_light(other) && other != heavy {
                    let back = successors(Some(place), |&place| Some(came_from[place]));
                    let lights = back.take_while(|&place| place > 0).map(|place| reached[place]);
                    return lights.min_by(|&p, &q| mass(p).total_cmp(&mass(q))).map(|light| [light, heavy]);
                }
            }
            place += 1;
        }
        None
    })
}

#[cfg(test)]
mod tests {

    use super::*;

    /// The squeezed bodies of rows between bodies of given masses [kg], of which the first is fixed.
    fn found(masses: &[f64], rows: &[[u32; 2]]) -> Option<[u32; 2]> {
        let rows: Vec<_> = rows.iter().map(|row| row.map(BodyId)).collect();
        let mass = |body: BodyId| if body.0 == 0 { f64::INFINITY } else { masses[body.index()] };
        squeezed(&rows, LARGEST_MASS_RATIO, mass).map(|bodies| bodies.map(|body| body.0))
    }

    #[test]
    fn a_light_body_below_a_heavy_one_is_squeezed() {
        assert_eq!(found(&[0.0, 1.0, 2e10], &[[0, 1], [1, 2]]), Some([1, 2]));
        assert_eq!(found(&[0.0, 1.0, 1e10], &[[0, 1], [1, 2]]), None);
        assert_eq!(found(&[0.0, 3.0, 1.0, 1e11], &[[0, 1], [1, 2], [2, 3]]), Some([2, 3]));
        assert_eq!(found(&[0.0, 1e11, 1.0, 1e11], &[[0, 1], [1, 2], [2, 3]]), Some([2, 1]));
    }

    #[test]
    fn light_bodies_on_a_heavy_one_or_within_it_are_not() {
        assert_eq!(found(&[0.0, 1e20, 1.0, 1.0], &[[0, 1], [1, 2], [2, 3], [1, 3]]), None);
        assert_eq!(found(&[0.0, 1.0, 1e20], &[[1, 2]]), None);
        assert_eq!(found(&[0.0, 1.0, 1e20], &[[0, 1], [0, 2]]), None);
        // A mote on an anvil is not what is squeezed below it.
        assert_eq!(found(&[0.0, 1.0, 1e-3, 1e13], &[[0, 1], [1, 3], [2, 3]]), Some([1, 3]));
    }
}
