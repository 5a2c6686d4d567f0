//! What friction adds to a new group: anchors of contacts that stick, works, and rows that need no equation.
//!
//! Two corners that lie flush on a side have one slip, and one anchor keeps both. With it and the gaps of both no motion of the two
//! bodies against each other is left: they are locked, as are a body that sticks in a notch and a ladder on a wall, and bodies that
//! hang together by locks move as one. Other rows between two such bodies follow from the locks; they are spare, and their forces are those that the event found. As forces of spare rows, and what
//! they add to those of the others, hold each other where they act, and turn along with the bodies, they stay as they are until
//! the group ends.

use crate::rigid::contacts::friction::{Axis, Grip};
use crate::rigid::contacts::rows::{ActiveRow, Mechanism, RowSource};
use crate::rigid::forest::Forest;
use crate::rigid::group::state::{Group, Work};
use crate::rigid::shares::{SEVERAL, TINY};
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Moving};

impl Group {
    /// Adds anchors and works of friction, and sets spare rows aside. `state_of` tells where a body is.
    pub(crate) fn add_friction(&mut self, mechanism: &Mechanism<'_>, state_of: impl Fn(BodyId) -> BodyState) {
        if !self.is_rough() {
            return;
        }
        let moving_of = |body: BodyId| {
            if body.is_world() { Moving::BACKGROUND } else { Moving::from(&state_of(body)) }
        };
        Axis::ALL.into_iter().for_each(|axis| self.add_anchors(mechanism, axis, moving_of));
        self.set_spares_aside(mechanism, moving_of);
        for (index, row) in self.rows.iter().enumerate() {
            if row.slips() {
                self.works.push(Work::Friction(number(index)));
            }
        }
        let runs = |row: &ActiveRow| row.is_rough() && mechanism.running_speed(row) != 0.0;
        if self.rows.iter().chain(&self.spares).any(runs) {
            self.works.push(Work::Surfaces);
        }
    }

    /// Adds the anchors of contacts that stick along an axis; contacts of the same two bodies and of one slip share theirs.
    fn add_anchors(
        &mut self,
        mechanism: &Mechanism<'_>,
        axis: Axis,
        moving_of: impl Fn(BodyId) -> Moving + Copy,
    ) {
        let sticks = |row: &ActiveRow| matches!(row.grip(axis), Grip::Sticks { .. });
        let mut contacts: Vec<([BodyId; 2], usize)> = (0..self.rows.len())
            .filter(|&index| sticks(&self.rows[index]))
            .map(|index| (sorted(self.rows[index].bodies), index))
            .collect();
        contacts.sort_unstable();
        for chunk in contacts.chunk_by(|one, other| one.0 == other.0) {
            let first = self.rows.len();
            for &(_, index) in chunk {
                let row = self.rows[index];
                let movings = row.bodies.map(moving_of);
                let Some(anchor) = mechanism.anchor_of(&row, axis, [&movings[0], &movings[1]]) else {
                    continue;
                };
                let shared = (first..self.rows.len())
                    .find(|&other| mechanism.is_same_anchor(&self.rows[other], &anchor, moving_of));
                let place = shared.unwrap_or(self.rows.len());
                if shared.is_none() {
                    self.rows.push(anchor);
                }
                self.rows[place].add_load(row.load[1 + axis as usize]);
                self.rows[index].keep_by(axis, number(place));
            }
        }
    }

    /// Sets aside the rows between bodies that locks hold together, but those of the locks. What stays is one body; each that is moved is another.
    fn set_spares_aside(&mut self, mechanism: &Mechanism<'_>, moving_of: impl Fn(BodyId) -> Moving + Copy) {
        let ground = self.bodies.len();
        let mut sets = Forest::default();
        sets.reset(ground + 1 + self.moved.len());
        let moved = self.moved.clone();
        let place = |bodies: &[BodyId], body: BodyId| {
            let of_moved = || moved.binary_search(&body).map_or(ground, |place| ground + 1 + place);
            bodies.binary_search(&body).unwrap_or_else(|_| of_moved())
        };
        let mut locks = vec![false; self.rows.len()];
        // What nothing else moves is not locked by what lies between.
        let leads = |sets: &mut Forest, set: usize| {
            (ground..=ground + moved.len()).any(|place| sets.root(place) == sets.root(set))
        };
        // Rows between two sets of locked bodies may lock these, too.
        loop {
            let mut between: Vec<([usize; 2], Bears, usize)> = Vec::new();
            for (index, row) in self.rows.iter().enumerate() {
                let [a, b] = row.bodies.map(|body| sets.root(place(&self.bodies, body)));
                if let Some(bears) = row.bears().filter(|_| a != b) {
                    between.push(([a.min(b), a.max(b)], bears, index));
                }
            }
            between.sort_unstable();
            let mut any = false;
            for chunk in between.chunk_by(|one, other| one.0 == other.0) {
                let [a, b] = chunk[0].0;
                if sets.root(a) == sets.root(b) || [a, b].iter().all(|&set| leads(&mut sets, set)) {
                    continue;
                }
                let of_second = |body: BodyId| sets.root(place(&self.bodies, body)) == sets.root(b);
                let rows = chunk.iter().map(|&(_, _, index)| (index, &self.rows[index]));
                if let Some(lock) = mechanism.lock_of(rows, of_second, moving_of) {
                    lock.into_iter().for_each(|row| locks[row] = true);
                    any |= sets.join(a, b);
                }
            }
            if !any {
                break;
            }
        }
        let is_spare: Vec<bool> = self
            .rows
            .iter()
            .zip(&locks)
            .map(|(row, &locks)| {
                let [a, b] = row.bodies.map(|body| sets.root(place(&self.bodies, body)));
                row.bears().is_some_and(|bears| bears != Bears::Anything) && !locks && a == b
            })
            .collect();
        // An anchor bears what the contacts may that it keeps, spare ones, too.
        for contact in (0..is_spare.len()).filter(|&row| is_spare[row]) {
            let row = self.rows[contact];
            for (anchor, coefficient) in row.kept_by() {
                self.rows[anchor].raise_bound(coefficient * row.load[0]);
            }
        }
        let mut of_locks = locks.into_iter().zip(&is_spare).filter(|(_, is_spare)| !**is_spare);
        self.locks.extend(of_locks.by_ref().map(|(locks, _)| locks));
        self.remove_spares(&is_spare);
    }

    /// Moves spare rows to their own list, spare anchors first.
    fn remove_spares(&mut self, is_spare: &[bool]) {
        let is_anchor = |row: &ActiveRow| matches!(row.source, RowSource::Anchor(_));
        let kept = is_spare.iter().filter(|is_spare| !**is_spare).count();
        let (mut next, mut next_anchor) = (0, kept);
        let new_places: Vec<u32> = is_spare
            .iter()
            .zip(&self.rows)
            .map(|(&is_spare, row)| {
                let place = if is_spare && is_anchor(row) { &mut next_anchor } else { &mut next };
                *place += usize::from(!is_spare || is_anchor(row));
                number(place.saturating_sub(1))
            })
            .collect();
        let mut flags = is_spare.iter();
        self.spares.extend(self.rows.extract_if(.., |_| flags.next() == Some(&true)));
        self.spares.sort_by_key(|row| !is_anchor(row));
        for row in self.rows.iter_mut().chain(&mut self.spares) {
            for axis in Axis::ALL {
                if let Grip::Sticks { anchor: Some(anchor), .. } = row.grip(axis) {
                    row.keep_by(axis, new_places[anchor as usize]);
                }
            }
        }
    }
}

/// What forces a row of a lock may bear. Where there are more rows than lock, those lock that bear more, and the forces of the others stay
/// as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Bears {
    /// Any, as a joint.
    Anything,
    /// Those that press.
    Pressure,
    /// Those up to a bound.
    Friction,
    /// Moments up to a bound: a contact that keeps a body from turning is watched until it opens, and must not be spare beside them.
    Rolling,
}

impl ActiveRow {
    /// What the row bears, if it can be one of a lock: a joint, a contact that does not slip, or an anchor.
    fn bears(&self) -> Option<Bears> {
        if self.third.is_some() {
            // It lets its two bodies move together with the third.
            return None;
        }
        match (self.source, self.grips[0]) {
            (RowSource::Pull(_), _) => None,
            (RowSource::Connector(..), _) => self.is_joint().then_some(Bears::Anything),
            (RowSource::Contact(_), _) => (!self.slips()).then_some(Bears::Pressure),
            (RowSource::Anchor(_), Grip::Anchor { axis: Axis::Turn, .. }) => Some(Bears::Rolling),
            (RowSource::Anchor(_), _) => Some(Bears::Friction),
        }
    }
}

impl Mechanism<'_> {
    /// Three of some rows between two sets of bodies that let these move against each other in no way; `None` if all of them leave
    /// some, or need no contact for that. A test tells the bodies of the second set.
    fn lock_of<'a>(
        &self,
        rows: impl Iterator<Item = (usize, &'a ActiveRow)>,
        mut is_second: impl FnMut(BodyId) -> bool,
        moving_of: impl Fn(BodyId) -> Moving,
    ) -> Option<[usize; 3]> {
        let mut found: Vec<(usize, [f64; 3])> = Vec::with_capacity(3);
        let (mut center, mut is_pressed) = (None, false);
        for (index, row) in rows {
            let movings = row.bodies.map(&moving_of);
            let side = usize::from(is_second(row.bodies[1]));
            let position = movings[side].pose.position;
            let solid = row.bodies.iter().filter(|body| !body.is_world());
            let reach = solid.map(|&body| self.trajectory_reach(body)).fold(f64::INFINITY, f64::min);
            // The coefficients of a motion of the set about one point, in units of the size of the lesser body.
            let (center, reach) = *center.get_or_insert((position, reach));
            let j = self.measure_between(row, [&movings[0], &movings[1]]).kinematics.jacobian;
            let (force, arm) = (DVec2::new(j[3 * side], j[3 * side + 1]), position - center);
            let mut left = [force.x, force.y, (j[3 * side + 2] + arm.perp_dot(force)) / reach];
            for (_, other) in &found {
                let share: f64 = left.iter().zip(other).map(|(p, q)| p * q).sum();
                left.iter_mut().zip(other).for_each(|(p, q)| *p -= share * q);
            }
            let size = left.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
            if size > TINY {
                is_pressed |= row.bears() == Some(Bears::Pressure);
                found.push((index, left.map(|entry| entry / size)));
            }
            if let [a, b, c] = found[..] {
                return is_pressed.then_some([a.0, b.0, c.0]);
            }
        }
        None
    }
}

fn number(place: usize) -> u32 {
    u32::try_from(place).unwrap_or(u32::MAX)
}

fn sorted([a, b]: [BodyId; 2]) -> [BodyId; 2] {
    if a <= b { [a, b] } else { [b, a] }
}

impl Mechanism<'_> {
    /// True if two anchors are of the same slip: those of two corners that lie flush on a side.
    fn is_same_anchor(
        &self,
        one: &ActiveRow,
        other: &ActiveRow,
        moving_of: impl Fn(BodyId) -> Moving,
    ) -> bool {
        let [mut first, mut second] = [one, other].map(|row| row.bodies);
        first.sort_unstable();
        second.sort_unstable();
        if first != second {
            return false;
        }
        let along = |row: &ActiveRow| {
            let sides = row.bodies.map(&moving_of);
            let [x, y, a, p, q, b] = self.measure_between(row, [&sides[0], &sides[1]]).kinematics.jacobian;
            if row.bodies == one.bodies { [x, y, a, p, q, b] } else { [p, q, b, x, y, a] }
        };
        let reach =
            one.bodies.iter().map(|&body| self.trajectories[body.index()].reach()).fold(0.0, f64::max);
        let off = along(one)
            .into_iter()
            .zip(along(other))
            .enumerate()
            .map(|(k, (p, q))| (p - q).abs() * if k % 3 == 2 { 1.0 } else { reach });
        off.fold(0.0, f64::max) <= SEVERAL * self.tolerances.accuracy
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::bodies::trajectory::FreeMotion;
    use crate::rigid::event::rooms::Rooms;
    use crate::rigid::group::groups::group_of;
    use crate::rigid::parts::{BodyPart, RigidParts};
    use crate::rigid::surface::Surface;
    use crate::rigid::test_scene::{FINE, rooms_of};
    use crate::time::Time;
    use halfgap_collision::Body;
    use halfgap_geometry::Shape;

    const ROUGH: Surface = Surface { friction: 0.5, static_friction: 0.5, ..Surface::SMOOTH };

    /// A body of a shape at a place, fixed or of 1 kg under gravity.
    fn part(shape: Result<Shape, halfgap_geometry::ShapeError>, fixed: bool, x: f64, y: f64) -> BodyPart {
        let inverse = if fixed { 0.0 } else { 1.0 };
        let body = Body {
            shape: shape.expect("a fine size"),
            inverse_mass: inverse,
            inverse_moment: 6.0 * inverse,
            elasticity: 0.0,
        };
        let free_motion = FreeMotion { acceleration: DVec2::new(0.0, -10.0), ..FreeMotion::default() };
        let state = BodyState { position: DVec2::new(x, y), ..BodyState::default() };
        BodyPart { surface: ROUGH, ..BodyPart::new(body, free_motion, state) }
    }

    fn floor() -> BodyPart {
        part(Shape::block(20.0, 1.0), true, 0.0, -0.5)
    }

    fn rooms(bodies: Vec<BodyPart>) -> Rooms {
        rooms_of(RigidParts { bodies, ..RigidParts::default() }, FINE, Time::ZERO)
    }

    /// Numbers of contacts, anchors, spare contacts and spare anchors of the group of body 1.
    fn counts(rooms: &Rooms) -> [usize; 4] {
        let group = group_of(&rooms.assembly, &rooms.groups, BodyId(1)).expect("it rests");
        let anchors =
            |rows: &[ActiveRow]| rows.iter().filter(|row| matches!(row.source, RowSource::Anchor(_))).count();
        let [rows, spares] = [group.rows(), group.spares()];
        [rows.len() - anchors(rows), anchors(rows), spares.len() - anchors(spares), anchors(spares)]
    }

    #[test]
    fn two_corners_on_a_side_have_one_anchor_and_nothing_spare() {
        let gap = FINE.tolerances.target_gap;
        let block = part(Shape::block(1.0, 1.0), false, 0.0, 0.5 + gap);
        assert_eq!(counts(&rooms(vec![floor(), block])), [2, 1, 0, 0]);
    }

    #[test]
    fn what_lies_on_two_locked_blocks_is_locked_by_one_and_spare_on_the_other() {
        let gap = FINE.tolerances.target_gap;
        let block = |x: f64, y: f64| part(Shape::block(1.0, 1.0), false, x, y);
        let bodies =
            vec![floor(), block(-0.6, 0.5 + gap), block(0.6, 0.5 + gap), block(0.0, 1.5 + 2.0 * gap)];
        // Each block is locked by two contacts and an anchor; the uppermost touches the other of those below in two places.
        let rooms = rooms(bodies);
        assert_eq!(counts(&rooms), [6, 3, 2, 1]);
        let group = group_of(&rooms.assembly, &rooms.groups, BodyId(1)).expect("it rests");
        // Forces are those that the event found, although half of them would do.
        for row in group.rows().iter().zip(group.forces()).filter(|(row, _)| row.touch().is_some()) {
            assert!(*row.1 > 1.0 && (row.1 - row.0.load[0]).abs() < 1e-6, "{row:?}");
        }
    }

    #[test]
    fn what_resists_rolling_locks_a_disc_and_is_spare_where_a_body_lies_flat() {
        let gap = FINE.tolerances.target_gap;
        let resisting = |shape| {
            let surface = Surface { rolling_resistance: 0.1, ..ROUGH };
            BodyPart { surface, ..part(shape, false, 0.0, 0.5 + gap) }
        };
        assert_eq!(counts(&rooms(vec![floor(), resisting(Shape::disc(0.5))])), [1, 2, 0, 0]);
        // Both round corners turn as one.
        let block = resisting(Shape::rounded_block(1.0, 1.0, 0.2));
        assert_eq!(counts(&rooms(vec![floor(), block])), [2, 1, 0, 1]);
    }

    #[test]
    fn a_disc_that_rolls_is_not_locked() {
        let gap = FINE.tolerances.target_gap;
        let disc = part(Shape::disc(0.5), false, 0.0, 0.5 + gap);
        assert_eq!(counts(&rooms(vec![floor(), disc])), [1, 1, 0, 0]);
    }
}
