//! Accelerations and forces of trees agree with those of the rows of their pins.

use super::build::MOST_BESIDE;
use crate::rigid::bodies::trajectory::{FreeMotion, Trajectory};
use crate::rigid::contacts::friction::Grip;
use crate::rigid::contacts::rows::{ActiveRow, Mechanism, RowSource};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::physics::Physics;
use crate::rigid::group::stage::{Stage, set_body_state};
use crate::rigid::group::state::Group;
use crate::rigid::remedies::{Remedies, RemedySet};
use crate::rigid::shares::{ROUNDED_FORCE, SMALL, TINY};
use crate::rigid::surfaces::Surfaces;
use crate::rigid::test_scene::FINE;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{
    Anchor, Body, BodyId, BodyState, Connector, ConnectorId, ConnectorKind, Moving, SlotFrame, Tolerances,
};
use halfgap_contact::InverseInertia;
use halfgap_geometry::Shape;
use proptest::prelude::*;

const TOLERANCES: Tolerances = Tolerances { target_gap: 1e-3, accuracy: 6e-4, velocity_tol: 1e-2 };
/// Acceptable error of a step [m].
const STEP_ERROR: f64 = 1e-9;
/// Kept share of a row beside pins and other rows above which softness has no visible effect.
const WELL_KEPT: f64 = 1e-3;

/// Support from which a body hangs.
#[derive(Clone, Copy, Debug)]
enum On {
    Nothing,
    World,
    /// One of the bodies before it, chosen by a number from 0 to 1.
    Earlier(f64),
}

#[derive(Clone, Debug)]
struct Hung {
    on: On,
    arms: [DVec2; 2],
    state: BodyState,
    mass: f64,
}

fn hung() -> impl Strategy<Value = Hung> {
    let on = prop_oneof![Just(On::Nothing), Just(On::World), (0.0..1.0).prop_map(On::Earlier)];
    let number = || -1.0..1.0;
    (on, prop::array::uniform8(number()), 0.1..10.0f64).prop_map(|(on, n, mass)| Hung {
        on,
        arms: [DVec2::new(n[0], n[1]), DVec2::new(n[2], n[3])],
        state: BodyState {
            position: DVec2::new(n[4], n[5]),
            angle: 3.0 * n[6],
            velocity: DVec2::new(n[3], n[4]),
            angular_velocity: 5.0 * n[7],
        },
        mass,
    })
}

/// The bodies of a tree with its connectors; bodies are numbered backwards.
struct Scene {
    trajectories: Vec<Trajectory>,
    connectors: Vec<Connector>,
    group: Group,
}

impl Scene {
    fn new(hung: &[Hung]) -> Self {
        let count = hung.len();
        let id = |place: usize| BodyId(u32::try_from(count - 1 - place).expect("few bodies"));
        let (mut states, mut connectors) = (Vec::<BodyState>::new(), Vec::new());
        for (place, body) in hung.iter().enumerate() {
            let mut state = body.state;
            let [own, arm] = body.arms;
            let parent = match body.on {
                On::Earlier(which) if place > 0 => Some((which * place as f64) as usize),
                _ => None,
            };
            let on = match parent {
                Some(parent) => Some((id(parent), states[parent].pose().point_to_world(arm))),
                None => matches!(body.on, On::World).then_some((BodyId::WORLD, arm)),
            };
            if let Some((other, pin)) = on {
                state.position = pin - state.pose().vector_to_world(own);
                let anchors = [Anchor { body: id(place), point: own }, Anchor { body: other, point: arm }];
                // Either may come first.
                let [a, b] = if place % 2 == 0 { anchors } else { [anchors[1], anchors[0]] };
                connectors.push(ConnectorKind::Pin { a, b });
            }
            states.push(state);
        }
        let trajectory = |(body, state): (&Hung, &BodyState)| {
            let shape = Shape::block(1.0, 0.4).expect("a fine block");
            let inverse_mass = body.mass.recip();
            let body = Body { shape, inverse_mass, inverse_moment: 3.0 * inverse_mass, elasticity: 0.5 };
            let free_motion = FreeMotion { acceleration: DVec2::new(0.3, -9.81), ..FreeMotion::default() };
            Trajectory::new(body, free_motion, *state, Time::ZERO)
        };
        let mut trajectories: Vec<_> = hung.iter().zip(&states).map(trajectory).collect();
        trajectories.reverse();
        let connectors = connectors.into_iter().map(|kind| Connector::new(kind, 0.0).expect("a fine pin"));
        let mut scene = Self { trajectories, connectors: connectors.collect(), group: Group::default() };
        for connector in 0..scene.connectors.len() {
            scene.hold(connector);
        }
        scene
    }

    /// Adds a connector between the first and the last body.
    fn connect(&mut self, kind: impl FnOnce([Anchor; 2]) -> ConnectorKind) {
        let last = self.trajectories.len() - 1;
        let ids = [BodyId(0), BodyId(u32::try_from(last).expect("few bodies"))];
        let point = DVec2::new(0.2, 0.1);
        let anchors = ids.map(|body| {
            let pose = self.trajectories[body.index()].state_at(Time::ZERO).pose();
            Anchor { body, point: pose.point_to_body(point) }
        });
        self.connectors.push(Connector::new(kind(anchors), 0.0).expect("a fine connector"));
        self.hold(self.connectors.len() - 1);
    }

    fn hold(&mut self, connector: usize) {
        let id = ConnectorId(u32::try_from(connector).expect("few connectors"));
        let bodies = self.connectors[connector].bodies();
        for row in 0..self.connectors[connector].row_count() {
            let source = RowSource::Connector(id, row);
            let (hint, leans) = (None, false);
            let row = ActiveRow {
                source,
                bodies,
                third: self.connectors[connector].third(),
                bilateral: true,
                gap: 0.0,
                hint,
                leans,
                grips: [Grip::Smooth; 2],
                load: [0.0; 3],
            };
            self.group.rows.push(row);
        }
    }

    /// Makes a group of all bodies and acts on its dynamics.
    fn with_dynamics<T>(mut self, act: impl FnOnce(&mut Dynamics<'_>) -> T) -> T {
        let count = self.trajectories.len();
        let Self { trajectories, connectors, group } = &mut self;
        group.bodies = (0..count).map(|place| BodyId(u32::try_from(place).expect("few bodies"))).collect();
        group.find_sides();
        let inertia = |trajectory: &Trajectory| InverseInertia {
            inverse_mass: trajectory.body().inverse_mass,
            inverse_moment: trajectory.body().inverse_moment,
        };
        let inertias: Vec<_> = trajectories.iter().map(inertia).collect();
        group.active.set_structure(&inertias, &group.sides);
        group.state = vec![0.0; 6 * count];
        for (place, trajectory) in trajectories.iter().enumerate() {
            set_body_state(&mut group.state, count, place, &trajectory.state_at(Time::ZERO));
        }
        let surfaces = &Surfaces::default();
        let mechanism = Mechanism { trajectories, surfaces, connectors, tolerances: &TOLERANCES, time: 0.0 };
        let remedies = &Remedies::new(RemedySet::NONE);
        let physics =
            Physics { mechanism, force_laws: &[], extra: None, steps: &FINE.steps, remedies, projects: true };
        let mut stage = Stage::new(vec![Moving::BACKGROUND; count]);
        act(&mut Dynamics { physics, group, stage: &mut stage, start: Time::ZERO })
    }

    /// Finds rates and forces by the rows and by the tree.
    fn told(self) -> Told {
        self.with_dynamics(|dynamics| {
            dynamics.set_out();
            let mut told = Told { by_rows: dynamics.group.rates.clone(), ..Told::default() };
            told.forces[0].clone_from(&dynamics.stage.forces);
            dynamics.find_tree_for(STEP_ERROR);
            dynamics.set_out();
            let Group { tree, state, rates, .. } = &*dynamics.group;
            (told.coordinates, told.kept) = (tree.count(), tree.loop_rows.least_kept);
            told.by_tree.clone_from(rates);
            let (state, mut rates) = (state.clone(), rates.clone());
            dynamics.find_rates(0.0, &state, &mut rates, Dynamics::hang_and_tell);
            told.forces[1].clone_from(&dynamics.stage.forces);
            told
        })
    }
}

/// Rates and forces of a group, by its rows and by its tree.
#[derive(Debug, Default)]
struct Told {
    /// Rates of the group's state by its rows.
    by_rows: Vec<f64>,
    /// Rates of the group's state by its tree.
    by_tree: Vec<f64>,
    /// Forces [N] of the rows, by the rows and by the tree.
    forces: [Vec<f64>; 2],
    /// Number of coordinates of the tree.
    coordinates: usize,
    /// The least kept share of a row beside the tree's pins.
    kept: f64,
}

impl Told {
    fn agrees(&self) -> bool {
        agree(&self.by_rows, &self.by_tree)
    }
}

fn agree(by_rows: &[f64], by_tree: &[f64]) -> bool {
    let largest = by_rows.iter().fold(1.0f64, |most, rate| most.max(rate.abs()));
    by_rows.iter().zip(by_tree).all(|(a, b)| (a - b).abs() <= ROUNDED_FORCE * largest)
}

proptest! {
    #[test]
    fn pins_that_close_no_loop_accelerate_as_their_rows_say(hung in prop::collection::vec(hung(), 1..8)) {
        let scene = Scene::new(&hung);
        let pins = scene.connectors.len();
        let told = scene.told();
        prop_assert_eq!(told.coordinates, if pins == 0 { 0 } else { 3 * hung.len() - 2 * pins });
        prop_assert!(told.agrees(), "{told:?}");
        prop_assert!(pins == 0 || agree(&told.forces[0], &told.forces[1]), "{told:?}");
    }

    #[test]
    fn what_is_held_beside_the_pins_pulls_the_tree(
        hung in prop::collection::vec(hung(), 3..8),
        kind in 0..3,
    ) {
        let mut hung = hung;
        for (place, body) in hung.iter_mut().enumerate() {
            body.on = if place == 0 { On::World } else { On::Earlier(0.99) };
        }
        let mut scene = Scene::new(&hung);
        scene.connect(|[a, b]| match kind {
            0 => ConnectorKind::Pin { a, b },
            1 => ConnectorKind::Slot { a, b, normal: DVec2::new(0.6, 0.8), frame: SlotFrame::B },
            _ => ConnectorKind::Rod { a: Anchor { point: a.point + DVec2::X, ..a }, b, length: 1.0 },
        });
        let told = scene.told();
        // Softness would show in nearly dependent rows.
        prop_assume!(told.kept > WELL_KEPT);
        prop_assert_eq!(told.coordinates, hung.len());
        prop_assert!(told.agrees(), "{told:?}");
        prop_assert!(agree(&told.forces[0], &told.forces[1]), "{told:?}");
    }
}

#[test]
fn a_pin_given_twice_is_told_to_be_singular() {
    let body = |on| Hung {
        on,
        arms: [DVec2::new(-0.5, 0.0), DVec2::new(0.5, 0.1)],
        state: BodyState { angular_velocity: 1.0, ..BodyState::default() },
        mass: 1.0,
    };
    let mut scene = Scene::new(&[body(On::World), body(On::Earlier(0.0)), body(On::Earlier(0.99))]);
    scene.connectors.push(scene.connectors[2].clone());
    scene.hold(3);
    scene.with_dynamics(|dynamics| {
        dynamics.set_out();
        dynamics.find_tree_for(STEP_ERROR);
        assert!(dynamics.group.tree.is_used());
        dynamics.set_out();
        assert!(dynamics.leave_singular_tree());
        assert!(!dynamics.group.tree.is_used());
    });
}

#[test]
fn more_loops_than_a_full_matrix_is_worth_are_left_to_the_rows() {
    let link = Hung {
        on: On::Earlier(0.99),
        arms: [DVec2::new(-0.5, 0.0), DVec2::new(0.5, 0.1)],
        state: BodyState::default(),
        mass: 1.0,
    };
    // A chain of forty bodies, with pins of two rows each beside.
    for (loops, is_used) in [(1, true), (MOST_BESIDE / 2, true), (MOST_BESIDE / 2 + 1, false)] {
        let mut scene = Scene::new(&vec![link.clone(); 40]);
        for _ in 0..loops {
            scene.connect(|[a, b]| ConnectorKind::Pin { a, b });
        }
        scene.with_dynamics(|dynamics| {
            dynamics.set_out();
            dynamics.find_tree_for(STEP_ERROR);
            assert_eq!(dynamics.group.tree.is_used(), is_used, "{loops} pins beside the chain");
        });
    }
}

/// A slot with a given normal at (0.2, 0.1), between a body that is pinned to the world and another.
fn slot_beside_a_pin(masses: [f64; 2], second: On, normal: DVec2) -> Scene {
    let body = |on, mass| Hung {
        on,
        arms: [DVec2::new(-0.5, 0.0), DVec2::ZERO],
        state: BodyState { angular_velocity: 1.0, ..BodyState::default() },
        mass,
    };
    let mut scene = Scene::new(&[body(On::World, masses[0]), body(second, masses[1])]);
    let normal = normal.normalize();
    scene.connect(|[a, b]| ConnectorKind::Slot { a, b, normal, frame: SlotFrame::World });
    scene
}

#[test]
fn what_softness_leaves_lacking_is_made_good() {
    // The row of a slot that pushes bodies nearly towards their pins has a kept share of some millionths.
    let scene = slot_beside_a_pin([1.0, 2.0], On::World, DVec2::new(2.0, 1.01));
    let told = scene.told();
    assert_eq!(told.coordinates, 2);
    assert!(told.kept < SMALL * TINY, "{}", told.kept);
    assert!(told.agrees(), "{told:?}");
}

#[test]
fn what_a_light_body_passes_on_to_a_heavy_one_is_not_softened() {
    // A slot that pushes a light body towards its pin moves only the heavy body: a fraction of the light one's square
    // that is below all softness. The lighter the light body, the less its mass matters.
    let of_milligrams = |milligrams: f64| {
        slot_beside_a_pin([milligrams / 1e6, 1.0], On::Nothing, DVec2::new(2.0, 1.0)).told()
    };
    let [light, lighter] = [1.0, 1.0 / 1000.0].map(of_milligrams);
    assert_eq!(lighter.coordinates, 4);
    assert!(lighter.kept > WELL_KEPT, "{}", lighter.kept);
    let difference =
        light.by_rows.iter().zip(&lighter.by_tree).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(difference < 1.0 / 1e6, "{light:?}\n{lighter:?}");
}
