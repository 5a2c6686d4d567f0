//! Construction of the tree of a group from its pins.

use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::contacts::rows::{ActiveRow, Mechanism, RowSource, moving_of};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::Group;
use crate::rigid::group::tree::{Bundle, Hinge, JointTree, Link, Stance};
use crate::rigid::settings::RigidSettings;
use glam::DVec2;
use halfgap_collision::Anchor;

/// Order of the error of a polynomial through both ends of a step, with rates, and the inner nodes.
const INNER_DEGREE: f64 = 9.0;
/// Largest error of that polynomial for a point that turns steadily by 2 rad, as a fraction of its distance from the
/// axis.
const INNER_ERROR: f64 = 3.86e-8;

/// Number of rows of a tree's pins from which on there may be as many other rows beside them: a tree of three pins may
/// be closed to a loop, which may fold, and only in angles it is led over that bifurcation point. Beside fewer pin rows
/// there may be half as many, or steps in the coordinates of the bodies are cheaper.
const LOOP: usize = 6;
/// Largest number of rows beside those of a tree's pins: their matrix is full, while that of all rows of the group has
/// a narrow band.
pub(super) const MOST_BESIDE: usize = 64;

/// A pin between two bodies, or a body and the world.
#[derive(Clone, Copy, Debug)]
struct Pin {
    anchors: [Anchor; 2],
    /// From the second point to the first [m], in world directions.
    gap: DVec2,
}

impl Dynamics<'_> {
    /// Finds the structure of the group's connectors, with the bodies in place: its tree, if it hangs by pins with few
    /// rows beside them, and whether there are closed loops. Neither is used if the scene asks for another remedy
    /// against drift than projection, or for a method without error estimate.
    pub(crate) fn find_tree_and_loops(&mut self, settings: &RigidSettings) {
        let Group { tree, loops, .. } = &mut *self.group;
        tree.clear();
        loops.clear();
        if settings.projection && self.physics.extra.is_none() && settings.method.is_adaptive() {
            // A tree hangs on points that stay.
            if self.group.moved.is_empty() {
                self.find_tree_for(settings.steps.local_error * settings.steps.length);
            }
            let Group { loops, bodies, rows, sides, thirds, .. } = &mut *self.group;
            loops.find(bodies.len(), rows, sides);
            loops.join_thirds(bodies.len(), sides, thirds);
        }
    }

    /// Finds the tree of the group, if it has one, where steps may err by `error` [m].
    pub(super) fn find_tree_for(&mut self, error: f64) {
        let Group { tree, bodies, rows, active, .. } = &mut *self.group;
        let mechanism = &self.physics.mechanism;
        if rows.iter().any(|row| !row.bilateral || row.anchor_bound().is_some()) || active.is_soft() {
            return;
        }
        tree.hung.clear();
        tree.link_of.clear();
        tree.link_of.resize(bodies.len(), None);
        let place = |anchor: &Anchor| bodies.binary_search(&anchor.body).ok();
        let trajectory = |place: usize| &mechanism.trajectories[bodies[place].index()];
        let pin_before = |second: usize| Some((second, pin_of(&rows[second - 1..=second], mechanism)?));
        let pins = (1..rows.len()).filter_map(pin_before);
        while tree.links.len() < bodies.len() {
            let before = tree.links.len();
            for (second, pin) in pins.clone() {
                for (child, parent) in [(0, 1), (1, 0)] {
                    let [own, on] = [&pin.anchors[child], &pin.anchors[parent]];
                    let Some(own_place) = place(own).filter(|&place| tree.link_of[place].is_none()) else {
                        continue;
                    };
                    let gap = if child == 0 { pin.gap } else { -pin.gap };
                    let hinge = match place(on) {
                        None => Hinge::World(
                            moving_of(&self.stage.movings, on.body).pose.point_to_world(on.point) + gap,
                        ),
                        Some(on_place) => match tree.link_of[on_place] {
                            Some(parent) => Hinge::Link { parent, arm: on.point, offset: gap },
                            None => continue,
                        },
                    };
                    tree.hang(own_place, hinge, own.point, trajectory(own_place));
                    tree.hung.extend([second - 1, second]);
                }
            }
            if tree.links.len() == before {
                let Some(free) = tree.link_of.iter().position(Option::is_none) else { break };
                tree.hang(free, Hinge::Free, DVec2::ZERO, trajectory(free));
            }
        }
        let JointTree { hung, loop_rows, links, .. } = &mut *tree;
        hung.sort_unstable();
        loop_rows.rows.extend((0..rows.len()).filter(|row| hung.binary_search(row).is_err()));
        let is_sound = |link: &Link| link.mass.is_finite() && link.moment.is_finite();
        let most = if hung.len() < LOOP { hung.len() / 2 } else { hung.len() };
        if loop_rows.rows.len() > most.min(MOST_BESIDE) || hung.is_empty() || !links.iter().all(is_sound) {
            tree.clear();
            return;
        }
        tree.complete(error);
    }
}

impl JointTree {
    fn hang(&mut self, place: usize, hinge: Hinge, own: DVec2, trajectory: &Trajectory) {
        self.link_of[place] = Some(self.links.len());
        self.numbers.0.push(3 * place + 2);
        if hinge == Hinge::Free {
            self.numbers.0.extend([3 * place, 3 * place + 1]);
        }
        let (body, reach) = (trajectory.body(), trajectory.reach() + own.length());
        self.links.push(Link {
            place,
            hinge,
            own,
            mass: body.inverse_mass.recip(),
            moment: body.inverse_moment.recip(),
            most_turn: f64::INFINITY,
            lever_square: reach * reach,
            descendants: 0,
        });
    }

    /// Sums up the bodies that hang on each, finds the angle by which each may turn in a step such that polynomials
    /// follow its points to within an error [m], and resizes the buffers.
    fn complete(&mut self, error: f64) {
        for link in &mut self.links {
            let reach = link.lever_square.sqrt();
            link.most_turn = 2.0 * libm::pow(error / (INNER_ERROR * reach), INNER_DEGREE.recip());
        }
        for index in (0..self.links.len()).rev() {
            let Hinge::Link { parent, arm, .. } = self.links[index].hinge else { continue };
            let hung = 1 + self.links[index].descendants;
            let on = &mut self.links[parent];
            on.descendants += hung;
            on.lever_square += hung as f64 * (arm - on.own).length_squared();
        }
        self.loop_rows.least_kept = f64::INFINITY;
        self.stances.clear();
        self.stances.resize(self.links.len(), Stance::default());
        self.bundles.clear();
        self.bundles.resize(self.links.len(), Bundle::default());
        self.inner.resize(self.links.len(), Default::default());
    }
}

/// The pin that two consecutive rows belong to; `None` if they are not those of a pin.
fn pin_of(rows: &[ActiveRow], mechanism: &Mechanism<'_>) -> Option<Pin> {
    let &[first, second] = rows else { return None };
    let RowSource::Connector(id, 0) = first.source else { return None };
    let (a, b) = mechanism.connectors[id.index()].held_together()?;
    let is_second = second.source == RowSource::Connector(id, 1);
    is_second.then_some(Pin { anchors: [*a, *b], gap: DVec2::new(first.gap, second.gap) })
}
