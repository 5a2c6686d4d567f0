//! Accelerations that are only rounding of contact forces.

use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::Stage;
use crate::rigid::shares::ROUNDED;
use halfgap_collision::BodyId;
use halfgap_contact::ThirdSide;

impl Dynamics<'_> {
    /// Sets accelerations to zero that are only rounding of the contact forces, so that a standing body does not creep
    /// because its sides are level only up to rounding.
    pub(super) fn level(&mut self) {
        let rounded = ROUNDED * self.stage.forces.iter().map(|force| force.abs()).sum::<f64>();
        let mut levels = std::mem::take(&mut self.stage.levels);
        levels.clear();
        let bodies = self.stage.accelerations.iter().zip(&self.group.bodies);
        levels.extend(bodies.map(|(acceleration, &body)| self.is_level(acceleration, body, rounded)));
        let any = levels.contains(&true);
        self.stage.levels = levels;
        if !any {
            return;
        }
        self.keep_pushed(rounded);
        let Stage { accelerations, levels, .. } = &mut *self.stage;
        for (acceleration, _) in accelerations.iter_mut().zip(levels).filter(|(_, is_level)| **is_level) {
            *acceleration = [0.0; 3];
        }
    }

    /// True if an acceleration is no larger than a force [N] at the centre, or at the body's reach, would make it.
    #[inline]
    fn is_level(&self, &[x, y, angular]: &[f64; 3], body: BodyId, force: f64) -> bool {
        let trajectory = &self.physics.mechanism.trajectories[body.index()];
        let (inertia, reach) = (trajectory.body(), trajectory.reach());
        let linear = force * inertia.inverse_mass;
        x * x + y * y <= linear * linear && angular.abs() <= force * inertia.inverse_moment * reach
    }

    /// Removes from the level bodies those that a row ties to a body which is not level and for which their
    /// acceleration counts: what is rounding for a light body under large forces need not be so for a heavy one under
    /// small ones.
    fn keep_pushed(&mut self, rounded: f64) {
        let trajectories = self.physics.mechanism.trajectories;
        let Stage { jacobians, accelerations, levels, .. } = &mut *self.stage;
        let mut any = levels.contains(&true) && levels.contains(&false);
        while std::mem::take(&mut any) {
            for (sides, jacobian) in self.group.sides.iter().zip(jacobians.iter()) {
                let &[Some(a), Some(b)] = sides else { continue };
                let (a, b) = (a as usize, b as usize);
                let (side, level, other) = if levels[a] { (0, a, b) } else { (1, b, a) };
                if levels[a] == levels[b] {
                    continue;
                }
                let row = &jacobian[3 * side..3 * side + 3];
                let pushed: f64 = row.iter().zip(&accelerations[level]).map(|(j, a)| j * a).sum();
                let inertia = trajectories[self.group.bodies[other].index()].body();
                if pushed.abs() > rounded * inertia.inverse_mass {
                    levels[level] = false;
                    any = true;
                }
            }
            any |= keep_turned(&self.group.sides, &self.group.thirds, levels);
        }
    }
}

/// Removes from the level bodies those that rows of three bodies tie to one which is not level; true if there are any.
fn keep_turned(sides: &[[Option<u32>; 2]], thirds: &[ThirdSide], levels: &mut [bool]) -> bool {
    let mut any = false;
    for third in thirds {
        let places = || sides[third.row as usize].into_iter().flatten().chain([third.body]);
        if !places().all(|place| levels[place as usize]) {
            any |= places().any(|place| levels[place as usize]);
            places().for_each(|place| levels[place as usize] = false);
        }
    }
    any
}
