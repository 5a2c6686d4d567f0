//! Steps of a group in the coordinates of its tree.

use crate::ode::{Ode, Point, SegmentPolynomial, Stepper, StiffnessEstimate};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::Group;
use crate::rigid::group::tree::Hinge;
use glam::DVec2;
use std::convert::Infallible;

/// Fraction of the acceptable errors that angles may have. Positions vary faster than angles, so that their error
/// estimates show more: at equal estimates a pendulum in angles errs by ten times as much.
const SHARE: f64 = 0.25;

/// Additional spin, as a multiple of the square root of the angular acceleration: dense output follows a body that
/// turns ever faster as well as one that turns steadily and by that much faster.
const UNSTEADY: f64 = 1.6;

/// A group stepped in the coordinates of its tree.
struct Hanging<'a, 'b>(&'a mut Dynamics<'b>);

impl Ode for Hanging<'_, '_> {
    type Error = Infallible;

    fn derivative(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        self.0.set_clock(offset);
        let Dynamics { physics, group, stage, start } = &mut *self.0;
        let Group { tree, bodies, force_laws, pulls, works, .. } = &mut **group;
        stage.evaluations += 1;
        let count = tree.count();
        tree.place(state, bodies, &mut stage.movings);
        rates[..count].copy_from_slice(&state[count..2 * count]);
        let (rates, powers) = rates[count..].split_at_mut(count);
        stage.accelerate(physics, (bodies, force_laws, pulls), start.seconds() + offset, works, powers);
        tree.accelerate(&mut stage.accelerations);
        self.0.hold_loop_rows();
        self.0.note_driving_powers(powers);
        let Group { tree, kept, .. } = &mut *self.0.group;
        if !tree.loop_rows.rows.is_empty() {
            kept.note(offset, tree.loop_rows.kept);
        }
        let Dynamics { group, stage, .. } = &mut *self.0;
        let (tree, accelerations) = (&group.tree, stage.accelerations.as_flattened());
        for (rate, &number) in rates.iter_mut().zip(&tree.numbers.0) {
            *rate = accelerations[number];
        }
        Ok(())
    }
}

impl Group {
    /// Copies the start of a step, with its rates, into the tree.
    fn gather_start(&mut self) {
        let velocities = self.velocities();
        let Self { tree, state, rates, .. } = self;
        tree.numbers.gather(state, velocities, &mut tree.state);
        tree.numbers.gather(rates, velocities, &mut tree.rates);
    }

    /// Copies the end of a step, with its rates, into the tree.
    fn gather_end(&mut self) {
        let velocities = self.velocities();
        let Self { tree, end_state, end_rates, .. } = self;
        tree.numbers.gather(end_state, velocities, &mut tree.end);
        tree.numbers.gather(end_rates, velocities, &mut tree.end_rates);
    }
}

impl Dynamics<'_> {
    /// Makes a step from the group's state and rates to its end state, in the coordinates of its tree.
    pub(crate) fn step_tree(&mut self, stepper: &mut Stepper, step: f64) {
        self.group.gather_start();
        let tree = &mut self.group.tree;
        let (state, rates) = (std::mem::take(&mut tree.state), std::mem::take(&mut tree.rates));
        let mut end = std::mem::take(&mut tree.end);
        end.clear();
        end.resize(state.len(), 0.0);
        let from = Point { offset: 0.0, state: &state, rates: &rates };
        let Ok(()) = stepper.step_open(&mut Hanging(self), from, step, &mut end);
        let mut whole = std::mem::take(&mut self.group.end_state);
        self.unfold(&end, &mut whole);
        self.group.end_state = whole;
        let tree = &mut self.group.tree;
        (tree.state, tree.rates, tree.end) = (state, rates, end);
    }

    /// Gives the stepper the rates at the end of a step, for a method whose error estimate takes them.
    pub(crate) fn close_step_of_tree(&mut self, stepper: &mut Stepper) {
        self.group.gather_end();
        stepper.close(&self.group.tree.end_rates);
    }

    /// Turns a state of the tree into one of the group.
    fn unfold(&mut self, state: &[f64], whole: &mut Vec<f64>) {
        let velocities = self.group.velocities();
        let Group { tree, bodies, .. } = &mut *self.group;
        let count = tree.count();
        tree.place(state, bodies, &mut self.stage.movings);
        whole.clear();
        whole.resize(2 * velocities, 0.0);
        for (place, body) in bodies.iter().enumerate() {
            let moving = &self.stage.movings[body.index()];
            let (at, velocity) = (3 * place, moving.velocity);
            whole[at..at + 2].copy_from_slice(&moving.pose.position.to_array());
            whole[velocities + at..velocities + at + 2].copy_from_slice(&velocity.to_array());
        }
        for (coordinate, &number) in tree.numbers.0.iter().enumerate() {
            whole[number] = state[coordinate];
            whole[velocities + number] = state[count + coordinate];
        }
        whole.extend_from_slice(&state[2 * count..]);
    }

    /// Moves bodies onto the pins of the tree: keeps their angles and the positions of free ones.
    pub(crate) fn fit_to_tree(&mut self, whole: &mut Vec<f64>) {
        let velocities = self.group.velocities();
        let tree = &mut self.group.tree;
        let mut state = std::mem::take(&mut tree.end);
        tree.numbers.gather(whole, velocities, &mut state);
        self.unfold(&state, whole);
        self.group.tree.end = state;
    }

    /// Turns the accelerations in the stage, which are without forces of rows, into those with them; bodies are in
    /// place. Leaves the forces of the rows beside the pins in the stage; those of the pins are not found.
    pub(crate) fn hang(&mut self) {
        self.stage.gap_error = self.largest_gap_error();
        self.stage.forces.clear();
        let Group { tree, bodies, .. } = &mut *self.group;
        tree.find_stances(bodies, &self.stage.movings);
        tree.accelerate(&mut self.stage.accelerations);
        self.hold_loop_rows();
    }

    /// Estimates the fastest rate of the tree from the last step.
    pub(crate) fn stiffness_of_tree(&mut self, stepper: &mut Stepper, scales: &[f64]) -> StiffnessEstimate {
        self.group.gather_end();
        let Group { tree, span, .. } = &*self.group;
        stepper.stiffness(Point { offset: *span, state: &tree.end, rates: &tree.end_rates }, scales)
    }

    /// Writes the errors of the tree's coordinates and their velocities that are just acceptable, from those of bodies,
    /// `linear` ([m], [m/s]). The mean square over the coordinates is to be that of the farthest points of the bodies:
    /// a change of an angle turns its body about its pin, and shifts all bodies that hang on it.
    pub(crate) fn scale_tree(&self, linear: [f64; 2], scales: &mut Vec<f64>) {
        let tree = &self.group.tree;
        let share = tree.count() as f64 / tree.links.len() as f64;
        for linear in linear.map(|linear| SHARE * linear) {
            for link in &tree.links {
                scales.push(linear / (share * link.lever_square).sqrt());
                if link.hinge == Hinge::Free {
                    let of_position = linear / (share * (1 + link.descendants) as f64).sqrt();
                    scales.extend([of_position; 2]);
                }
            }
        }
    }

    /// The longest step [s] over which no body of the tree turns by more than its `most_turn`. Dense output of a body
    /// that turns unsteadily errs as if it turned by more: the high derivatives of its points contain angular
    /// accelerations, too.
    pub(crate) fn longest_turning_step(&self) -> f64 {
        let Group { tree, state, rates, .. } = &*self.group;
        let velocities = self.group.velocities();
        let steps = tree.links.iter().map(|link| {
            let number = velocities + 3 * link.place + 2;
            let (spin, angular) = (state[number].abs(), rates[number].abs());
            if spin == 0.0 && angular == 0.0 {
                return f64::INFINITY;
            }
            let spin = spin + UNSTEADY * angular.sqrt();
            2.0 * link.most_turn / (spin + (spin * spin + 2.0 * angular * link.most_turn).sqrt())
        });
        steps.fold(f64::INFINITY, f64::min)
    }

    /// Writes the dense output of the last step of a tree into the group's paths: that of the coordinates is made by
    /// the stepper, those of the other positions interpolate the places given by the coordinates at the ends and
    /// between.
    pub(crate) fn make_dense_of_tree(&mut self, stepper: &mut Stepper) {
        self.group.gather_start();
        self.group.gather_end();
        let tree = &mut self.group.tree;
        let mut state = std::mem::take(&mut tree.state);
        let (end, end_rates) = (std::mem::take(&mut tree.end), std::mem::take(&mut tree.end_rates));
        let mut velocities = std::mem::take(&mut self.group.tree.velocities);
        let count = self.group.tree.count();
        velocities.resize(state.len() - count, SegmentPolynomial::default());
        let end_point = Point { offset: self.group.span, state: &end, rates: &end_rates };
        let Ok(()) = stepper.dense(&mut Hanging(self), end_point, count..state.len(), &mut velocities);
        let angles = &mut self.group.tree.angles;
        angles.clear();
        let integrated = |at: usize| SegmentPolynomial::integrated(state[at], end[at], &velocities[at]);
        angles.extend((0..count).map(integrated));
        self.place_inner(&mut state);
        self.join_inner(&velocities);
        self.group.tree.velocities = velocities;
        let tree = &mut self.group.tree;
        (tree.state, tree.end, tree.end_rates) = (state, end, end_rates);
    }

    /// Finds the positions of the bodies at the inner nodes of the step; `state` is a buffer.
    fn place_inner(&mut self, state: &mut [f64]) {
        let Group { tree, bodies, span, .. } = &mut *self.group;
        let count = tree.count();
        for (node, part) in SegmentPolynomial::INNER.into_iter().enumerate() {
            for (value, path) in state[..count].iter_mut().zip(&tree.angles) {
                *value = path.value_at(part * *span);
            }
            tree.place(state, bodies, &mut self.stage.movings);
            for (inner, link) in tree.inner.iter_mut().zip(&tree.links) {
                inner[node] = self.stage.movings[bodies[link.place].index()].pose.position;
            }
        }
    }

    /// Makes the paths of the bodies; `velocities` are those of the coordinates, followed by the works.
    fn join_inner(&mut self, velocities: &[SegmentPolynomial]) {
        let first_velocity = self.group.velocities();
        let Group { tree, bodies, paths, rate_paths, state, end_state, span, .. } = &mut *self.group;
        paths.clear();
        paths.resize(bodies.len(), Default::default());
        rate_paths.clear();
        rate_paths.resize(first_velocity, SegmentPolynomial::default());
        rate_paths.extend_from_slice(&velocities[tree.count()..]);
        let mut at = 0;
        for (link, inner) in tree.links.iter().zip(&tree.inner) {
            let (path, rates) = (&mut paths[link.place], &mut rate_paths[3 * link.place..][..3]);
            (path[2], rates[2]) = (tree.angles[at], velocities[at]);
            if link.hinge == Hinge::Free {
                path[..2].copy_from_slice(&tree.angles[at + 1..at + 3]);
                rates[..2].copy_from_slice(&velocities[at + 1..at + 3]);
                at += 3;
                continue;
            }
            at += 1;
            for (axis, (path, rate)) in path.iter_mut().zip(rates).take(2).enumerate() {
                let number = 3 * link.place + axis;
                let ends =
                    [&*state, &*end_state].map(|whole| [whole[number], whole[first_velocity + number]]);
                let of_axis = |place: &DVec2| if axis == 0 { place.x } else { place.y };
                *path = SegmentPolynomial::through(ends, inner.each_ref().map(of_axis), *span);
                *rate = path.derivative();
            }
        }
    }
}
