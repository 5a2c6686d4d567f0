//! Places of a group's bodies along its segment: of all of them with their velocities, or only the poses of those whose
//! gaps are watched.

use crate::rigid::contacts::rows::ActiveRow;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::Group;
use glam::DVec2;
use halfgap_geometry::Pose;

impl Dynamics<'_> {
    /// Places the group's bodies according to a state at an offset [s] of the segment.
    pub(crate) fn load(&mut self, state: &[f64], offset: f64) {
        self.set_clock(offset);
        self.stage.load(&self.group.bodies, state);
    }

    /// Sets the offset [s] in the segment at which rows are measured from now on, and places what is moved there.
    pub(super) fn set_clock(&mut self, offset: f64) {
        self.physics.mechanism.time = self.start.seconds() + offset;
        if !self.group.moved.is_empty() {
            self.place_moved(offset);
        }
    }

    /// Gives all of the group's bodies their poses and velocities at an offset [s] of the segment.
    pub(crate) fn place_at(&mut self, offset: f64) {
        self.find_state_at(offset);
        let trial = std::mem::take(&mut self.stage.trial);
        self.load(&trial, offset);
        self.stage.trial = trial;
    }

    /// Finds the state of the group at an offset [s] of the segment, and leaves it in the stage.
    pub(crate) fn find_state_at(&mut self, offset: f64) {
        let trial = &mut self.stage.trial;
        trial.clear();
        let paths = self.group.paths.iter().flatten();
        trial.extend(paths.map(|path| path.value_at(offset)));
        let velocities = &self.group.rate_paths[..self.group.velocities()];
        trial.extend(velocities.iter().map(|path| path.value_at(offset)));
        trial.resize(self.group.dimension(), 0.0);
    }

    /// Chooses the watched bodies: those of the chosen rows, and of all contacts without force.
    pub(crate) fn watch_rows(&mut self, watches: impl Fn(usize) -> bool) {
        let Group { bodies, sides, thirds, idle, .. } = &*self.group;
        let of_rows = (0..sides.len()).filter(|&row| watches(row)).flat_map(|row| sides[row]).flatten();
        let of_thirds = thirds.iter().filter(|third| watches(third.row as usize)).map(|third| third.body);
        let place_of = |body| bodies.binary_search(body).ok().and_then(|place| u32::try_from(place).ok());
        let of_idle = idle.iter().flat_map(|ActiveRow { bodies, .. }| bodies).filter_map(place_of);
        let watched = &mut self.stage.watched;
        watched.clear();
        watched.extend(of_rows.chain(of_thirds).chain(of_idle));
        watched.sort_unstable();
        watched.dedup();
    }

    /// Gives the watched bodies their poses at an offset [s] of the segment; their velocities are left as they are.
    pub(crate) fn put_watched_at(&mut self, offset: f64) {
        self.set_clock(offset);
        for index in 0..self.stage.watched.len() {
            self.put(self.stage.watched[index] as usize, offset);
        }
    }

    /// Gives the bodies of a row their poses at an offset [s] of the segment.
    pub(crate) fn put_row_at(&mut self, row: usize, offset: f64) {
        self.set_clock(offset);
        let third = self.group.thirds.iter().find(|third| third.row as usize == row).map(|third| third.body);
        for place in self.group.sides[row].into_iter().flatten().chain(third) {
            self.put(place as usize, offset);
        }
    }

    /// Gives the bodies of a contact without force their poses at an offset [s] of the segment.
    pub(crate) fn put_idle_at(&mut self, row: usize, offset: f64) {
        self.set_clock(offset);
        for body in self.group.idle[row].bodies {
            if let Ok(place) = self.group.bodies.binary_search(&body) {
                self.put(place, offset);
            }
        }
    }

    /// Gives all of the group's bodies their poses at an offset [s] of the segment.
    pub(crate) fn put_at(&mut self, offset: f64) {
        self.set_clock(offset);
        (0..self.group.bodies.len()).for_each(|place| self.put(place, offset));
    }

    fn put(&mut self, place: usize, offset: f64) {
        let [x, y, angle] = &self.group.paths[place];
        let position = DVec2::new(x.value_at(offset), y.value_at(offset));
        let body = self.group.bodies[place];
        let angle = angle.value_at(offset);
        let moving = &mut self.stage.movings[body.index()];
        (moving.pose, moving.angle) = (Pose::new(position, angle), angle);
    }
}

#[cfg(test)]
mod tests {
    use crate::rigid::event::rooms::Rooms;
    use crate::rigid::group::groups::with_group;
    use crate::rigid::test_scene::{block_on_its_corner, resting_discs};
    use crate::rigid::watch::extending::extend_watched;
    use glam::DVec2;
    use halfgap_collision::{BodyId, Moving};

    /// Motions of all bodies in the middle of a segment along which one body slides and turns: placed by `place_at`,
    /// and with only the poses put.
    fn placed_and_put(mut rooms: Rooms, body: BodyId) -> [Vec<Moving>; 2] {
        let mut group = rooms.groups.take(body).expect("it is in a group");
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, tools| {
            let at = dynamics.group.velocities();
            (dynamics.group.state[at], dynamics.group.state[at + 2]) = (0.7, 0.3);
            dynamics.set_out();
            extend_watched(dynamics, tools).expect("it slides");
            let middle = 0.5 * dynamics.group.span;
            dynamics.place_at(middle);
            let placed = dynamics.stage.movings.clone();
            dynamics.watch_rows(|row| row == 0);
            let puts: [fn(&mut super::Dynamics<'_>, f64); 3] = [
                |dynamics, offset| dynamics.put_watched_at(offset),
                |dynamics, offset| dynamics.put_row_at(0, offset),
                |dynamics, offset| dynamics.put_at(offset),
            ];
            let mut put = Vec::new();
            for act in puts {
                dynamics.put_at(0.0);
                assert!(dynamics.stage.movings[body.index()] != placed[body.index()]);
                act(dynamics, middle);
                put = dynamics.stage.movings.clone();
                assert_eq!(put[body.index()].pose, placed[body.index()].pose);
            }
            [placed, put]
        })
    }

    #[test]
    fn a_body_that_is_put_is_where_it_is_placed() {
        for rooms in [resting_discs(&[0.0]), block_on_its_corner()] {
            let [placed, put] = placed_and_put(rooms, BodyId(1));
            assert!(placed[1].velocity.distance(DVec2::ZERO) > 0.0);
            assert_eq!(placed, put, "velocities stay what they were");
        }
    }
}
