//! Active rows beside the pins of a tree: those of pins that close loops, of slots, rods, rails.
//!
//! A row pulls the whole tree. With C the accelerations of the tree under a force of 1 N along each row, and J the
//! Jacobian of the rows, the forces f follow from G f = -(J v' + gamma), G = J C. The rows are few, so G is dense.
//!
//! The kept share of a row is the fraction of its square J M^-1 J^T, without pins, that the pins and the rows before it
//! leave: it vanishes in singular configurations (see `singular`).

use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::Stage;
use crate::rigid::group::state::Group;
use crate::rigid::group::tree::{Hinge, JointTree};
use crate::rigid::shares::{LARGE, ROUNDS};
use glam::DVec2;
use halfgap_contact::ThirdSide;

/// Kept share of a row at or below which a new tree is given up: its rows depend on each other.
const SINGULAR: f64 = 1e-6;

/// Softness that is added to a kept share of 0. Loops pass bifurcation points, where their rows depend on each other
/// for a moment, and where the forces that hold them are finite but lost in rounding. The error that softness makes
/// lasts while the loop is within the square root of this (as an angle) of the point, and falls fast farther away.
const SOFTNESS: f64 = 1e-8;

/// The rows beside the pins of a tree, with their buffers.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct LoopRows {
    /// Indices of the rows in the group.
    pub(super) rows: Vec<usize>,
    /// Accelerations of the bodies of the group under each row's unit force, row by row.
    columns: Vec<[f64; 3]>,
    /// Lower triangle of the factors L D L^T of G, line by line.
    factor: Vec<f64>,
    /// The least kept share since the tree was made.
    pub(super) least_kept: f64,
    /// The least kept share when the rows were factorised last.
    pub(super) kept: f64,
    /// The largest fraction of a kept share, softness included, that is softness.
    softness: f64,
    /// Residual of each row's equation.
    lacking: Vec<f64>,
    /// Corrections [N] of the forces for these residuals.
    corrections: Vec<f64>,
}

/// The bodies that a row acts on, by their places in the group: its two, and a third one with the coefficient [m] of its rotation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    sides: [Option<u32>; 2],
    third: Option<(u32, f64)>,
}

/// The bodies of a row of a group.
fn ends_of(sides: &[[Option<u32>; 2]], thirds: &[ThirdSide], row: usize) -> Ends {
    let third = thirds.iter().find(|third| third.row as usize == row);
    Ends { sides: sides[row], third: third.map(|third| (third.body, third.coefficient)) }
}

impl JointTree {
    /// Factorises G for the rows in their order, after the sweep inwards.
    fn factorize(&mut self, jacobians: &[[f64; 6]], ends: impl Fn(usize) -> Ends) {
        let bodies = self.links.len();
        let mut columns = std::mem::take(&mut self.loop_rows.columns);
        columns.clear();
        columns.resize(jacobians.len() * bodies, [0.0; 3]);
        self.loop_rows.factor.clear();
        (self.loop_rows.softness, self.loop_rows.kept) = (0.0, f64::INFINITY);
        for (row, jacobian) in jacobians.iter().enumerate() {
            let column = &mut columns[row * bodies..][..bodies];
            self.pull(jacobian, ends(row), column);
        }
        for (row, jacobian) in jacobians.iter().enumerate() {
            let responses = columns.chunks(bodies).take(row + 1);
            self.loop_rows.factor.extend(responses.map(|column| rate(jacobian, ends(row), column)));
            let whole = self.square_of(jacobian, ends(row));
            self.loop_rows.eliminate(row, whole);
        }
        self.loop_rows.columns = columns;
    }

    /// J M^-1 J^T of a row by itself, without pins, at most [`LARGE`] times that of its heavier side. The part of a
    /// much lighter body would be larger, but is often held by a pin to which the row points.
    fn square_of(&self, jacobian: &[f64; 6], Ends { sides, third }: Ends) -> f64 {
        let of_side = |(side, place): (usize, Option<u32>)| {
            let Some(link) =
                place.and_then(|place| self.link_of[place as usize]).map(|index| &self.links[index])
            else {
                return 0.0;
            };
            let force = DVec2::new(jacobian[3 * side], jacobian[3 * side + 1]);
            let torque = jacobian[3 * side + 2];
            force.length_squared() / link.mass + torque * torque / link.moment
        };
        let squares = [(0, sides[0]), (1, sides[1])].map(of_side);
        let of_third = third.and_then(|(place, j)| {
            self.link_of[place as usize].map(|index| j * j / self.links[index].moment)
        });
        let all = || squares.into_iter().chain(of_third);
        let heavier = all().filter(|&square| square > 0.0).fold(f64::INFINITY, f64::min);
        all().sum::<f64>().min(LARGE * heavier)
    }

    /// Accelerations of the tree, body by body of the group, under a force of 1 N along a row.
    fn pull(&mut self, jacobian: &[f64; 6], Ends { sides, third }: Ends, column: &mut [[f64; 3]]) {
        for bundle in &mut self.bundles {
            (bundle.force, bundle.torque) = (DVec2::ZERO, 0.0);
        }
        for (side, place) in sides.into_iter().enumerate() {
            let Some(index) = place.and_then(|place| self.link_of[place as usize]) else { continue };
            let force = DVec2::new(jacobian[3 * side], jacobian[3 * side + 1]);
            let center = -self.stances[index].own;
            let bundle = &mut self.bundles[index];
            bundle.force -= force;
            bundle.torque -= center.perp().dot(force) + jacobian[3 * side + 2];
        }
        if let Some((place, j)) = third
            && let Some(index) = self.link_of[place as usize]
        {
            self.bundles[index].torque -= j;
        }
        for index in (0..self.links.len()).rev() {
            let Hinge::Link { parent, .. } = self.links[index].hinge else { continue };
            let force = self.bundles[index].resistance();
            let on = &mut self.bundles[parent];
            on.force += force;
            on.torque += self.stances[index].of_parent.perp().dot(force);
        }
        for index in 0..self.links.len() {
            let link = &self.links[index];
            let acceleration = match link.hinge {
                Hinge::World(_) => DVec2::ZERO,
                Hinge::Free => self.bundles[index].free_acceleration(),
                Hinge::Link { parent, .. } => {
                    let on = &self.bundles[parent];
                    on.acceleration + self.stances[index].of_parent.perp() * on.angular
                }
            };
            let of_center = self.bundles[index].turn(acceleration, self.stances[index].own);
            column[link.place] = [of_center.x, of_center.y, self.bundles[index].angular];
        }
    }
}

impl LoopRows {
    /// Turns the last line of G into one of its factor, for a row whose square is `whole`.
    fn eliminate(&mut self, row: usize, whole: f64) {
        let begin = row * (row + 1) / 2;
        let (done, line) = self.factor.split_at_mut(begin);
        for column in 0..row {
            let other = &done[column * (column + 1) / 2..][..column];
            let known: f64 = other.iter().zip(&*line).map(|(a, b)| a * b).sum();
            line[column] -= known;
        }
        for column in 0..row {
            let pivot = done[column * (column + 1) / 2 + column];
            let entry = line[column] / pivot;
            line[row] -= entry * line[column];
            line[column] = entry;
        }
        // A row that moves no body depends on the others.
        let whole = if whole > 0.0 { whole } else { 1.0 };
        let kept = line[row].max(0.0) / whole;
        self.kept = self.kept.min(kept);
        self.least_kept = self.least_kept.min(kept);
        let softness = SOFTNESS * (SOFTNESS / (kept + SOFTNESS)).powi(2);
        line[row] = whole * (kept + softness);
        self.softness = self.softness.max(softness / (kept + softness));
    }

    /// Solves G x = -`offsets`.
    fn solve(&self, offsets: &[f64], x: &mut Vec<f64>) {
        let line = |row: usize| &self.factor[row * (row + 1) / 2..][..=row];
        x.clear();
        for (row, offset) in offsets.iter().enumerate() {
            let known: f64 = line(row).iter().zip(&*x).map(|(entry, x)| entry * x).sum();
            x.push(-offset - known);
        }
        for (row, x) in x.iter_mut().enumerate() {
            *x /= line(row)[row];
        }
        for row in (0..x.len()).rev() {
            let (earlier, later) = x.split_at_mut(row);
            for (x, entry) in earlier.iter_mut().zip(line(row)) {
                *x -= entry * later[0];
            }
        }
    }

    /// Adds the responses C f of the bodies to forces f along the rows to `changes`.
    fn pull_all(&self, forces: &[f64], changes: &mut [[f64; 3]]) {
        for (column, force) in self.columns.chunks(changes.len()).zip(forces) {
            for (change, response) in changes.iter_mut().zip(column) {
                for k in 0..3 {
                    change[k] += force * response[k];
                }
            }
        }
    }
}

/// J a: acceleration [m/s^2] of a row's gap by accelerations of its bodies.
fn rate(jacobian: &[f64; 6], Ends { sides, third }: Ends, accelerations: &[[f64; 3]]) -> f64 {
    let of_side = |(side, place): (usize, Option<u32>)| {
        let acceleration = place.map_or([0.0; 3], |place| accelerations[place as usize]);
        (0..3).map(|k| jacobian[3 * side + k] * acceleration[k]).sum::<f64>()
    };
    let of_two = sides.into_iter().enumerate().map(of_side).sum();
    third.map_or(of_two, |(place, j)| of_two + j * accelerations[place as usize][2])
}

impl Dynamics<'_> {
    /// Gives the tree up if the rows beside its pins have turned out to depend on each other; true if they have.
    pub(crate) fn leave_singular_tree(&mut self) -> bool {
        let loop_rows = &self.group.tree.loop_rows;
        let is_singular = !loop_rows.rows.is_empty() && loop_rows.least_kept <= SINGULAR;
        if is_singular {
            self.group.tree.clear();
        }
        is_singular
    }

    /// Adds the response to the rows beside the pins to the accelerations in the stage, which are those with the pins
    /// alone.
    pub(super) fn hold_loop_rows(&mut self) {
        if self.group.tree.loop_rows.rows.is_empty() {
            return;
        }
        self.stage.jacobians.clear();
        self.stage.offsets.clear();
        let mut twin = None;
        for &row in &self.group.tree.loop_rows.rows {
            let active = &self.group.rows[row];
            let moment = self.physics.mechanism.measure_next(active, &self.stage.movings, &mut twin);
            let spins = self.group.sides[row].map(|place| self.stage.spin_at(place));
            let mut offset = moment.kinematics.acceleration(&spins[0], &spins[1]);
            if let Some((place, j)) = ends_of(&self.group.sides, &self.group.thirds, row).third {
                offset += j * self.stage.spin_at(Some(place)).angular;
            }
            self.stage.offsets.push(offset);
            self.stage.jacobians.push(moment.kinematics.jacobian);
        }
        self.factorize_loop_rows();
        self.respond_by_tree();
        for (acceleration, change) in self.stage.accelerations.iter_mut().zip(&self.stage.changes) {
            for k in 0..3 {
                acceleration[k] += change[k];
            }
        }
    }

    fn factorize_loop_rows(&mut self) {
        let Group { tree, sides, thirds, .. } = &mut *self.group;
        let rows = std::mem::take(&mut tree.loop_rows.rows);
        tree.factorize(&self.stage.jacobians, |row| ends_of(sides, thirds, rows[row]));
        tree.loop_rows.rows = rows;
    }

    /// Measures the rows beside the pins, with the bodies in place, and factorises; calls `visit` with the error [m] of
    /// each gap and its rate [m/s].
    pub(crate) fn factorize_by_tree(&mut self, mut visit: impl FnMut(f64, f64)) {
        self.stage.jacobians.clear();
        let mut twin = None;
        for &row in &self.group.tree.loop_rows.rows {
            let active = &self.group.rows[row];
            let moment = self.physics.mechanism.measure_next(active, &self.stage.movings, &mut twin);
            self.stage.jacobians.push(moment.kinematics.jacobian);
            visit(moment.gap - active.gap, moment.kinematics.rate);
        }
        let Group { tree, bodies, .. } = &mut *self.group;
        tree.find_stances(bodies, &self.stage.movings);
        self.stage.accelerations.clear();
        self.stage.accelerations.resize(bodies.len(), [0.0; 3]);
        tree.sweep_in(&self.stage.accelerations);
        self.factorize_loop_rows();
    }

    /// Solves G x = -`offsets`, leaves x in `forces`, and C x in `changes`.
    pub(crate) fn respond_by_tree(&mut self) {
        let Group { tree, sides, thirds, .. } = &mut *self.group;
        let bodies = tree.links.len();
        let Stage { jacobians, offsets, forces, changes, .. } = &mut *self.stage;
        changes.clear();
        changes.resize(bodies, [0.0; 3]);
        tree.loop_rows.solve(offsets, forces);
        tree.loop_rows.pull_all(forces, changes);
        let mut left = tree.loop_rows.softness;
        let mut lacking = std::mem::take(&mut tree.loop_rows.lacking);
        let mut corrections = std::mem::take(&mut tree.loop_rows.corrections);
        for _ in 0..ROUNDS {
            if left <= f64::EPSILON {
                break;
            }
            lacking.clear();
            let rows = tree.loop_rows.rows.iter().zip(&*jacobians).zip(&*offsets);
            let ends = |row: usize| ends_of(sides, thirds, row);
            lacking
                .extend(rows.map(|((&row, jacobian), offset)| offset + rate(jacobian, ends(row), changes)));
            tree.loop_rows.solve(&lacking, &mut corrections);
            tree.loop_rows.pull_all(&corrections, changes);
            forces.iter_mut().zip(&corrections).for_each(|(force, correction)| *force += correction);
            left *= tree.loop_rows.softness;
        }
        (tree.loop_rows.lacking, tree.loop_rows.corrections) = (lacking, corrections);
        self.stage.solves += 1;
    }
}
