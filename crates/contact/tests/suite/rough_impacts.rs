//! Impacts with friction: no law gains energy, jams are solved, and what is known in closed form comes out.

use crate::friction::Random;
use halfgap_contact::collision::BodyId;
use halfgap_contact::{
    CollisionRow, FrictionRow, Impact, ImpactError, ImpactLaw, ImpactOrder, InverseInertia, Restitution,
    RowKind,
};

const FIXED: InverseInertia = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
const LAWS: [ImpactLaw; 6] = [
    ImpactLaw::Simultaneous,
    ImpactLaw::Hybrid,
    ImpactLaw::SerialSeparate,
    ImpactLaw::SerialGrouped,
    ImpactLaw::SerialSeparateLastpass,
    ImpactLaw::SerialGroupedLastpass,
];

/// A body of a random impact.
#[derive(Clone, Copy)]
struct Struck {
    inertia: InverseInertia,
    velocity: [f64; 3],
}

/// A normal row and its tangential one: Jacobians of bodies, which are `None` for the background.
#[derive(Clone, Copy)]
struct Touch {
    bodies: [Option<usize>; 2],
    jacobians: [[f64; 6]; 2],
    friction: f64,
    elasticity: f64,
}

/// A random impact of some bodies.
struct Case {
    bodies: Vec<Struck>,
    touches: Vec<Touch>,
}

impl Case {
    /// `bodies` bodies and `contacts` contacts between them and the background, at random places.
    fn random(bodies: usize, contacts: usize, random: &mut Random) -> Self {
        let mut body = || {
            let mass = 10.0_f64.powf(random.between(-1.0, 1.0));
            let inertia = InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 6.0 / mass };
            let mut own = || random.between(-1.0, 1.0);
            Struck { inertia, velocity: [own(), own(), own()] }
        };
        let bodies: Vec<Struck> = (0..bodies).map(|_| body()).collect();
        let touches = (0..contacts)
            .map(|_| {
                let first = random.between(0.0, bodies.len() as f64) as usize;
                let second = random.between(0.0, bodies.len() as f64 + 1.0) as usize;
                let second = Some(second).filter(|&second| second < bodies.len() && second != first);
                let angle = random.between(0.0, std::f64::consts::TAU);
                let (sin, cos) = angle.sin_cos();
                let mut arm = || [random.between(-0.5, 0.5), random.between(-0.5, 0.5)];
                let arms = [arm(), arm()];
                let jacobian = |n: [f64; 2]| {
                    let turn = |arm: [f64; 2]| arm[0] * n[1] - arm[1] * n[0];
                    [n[0], n[1], turn(arms[0]), -n[0], -n[1], -turn(arms[1])]
                };
                Touch {
                    bodies: [Some(first), second],
                    jacobians: [jacobian([cos, sin]), jacobian([-sin, cos])],
                    friction: random.between(0.0, 2.0),
                    elasticity: random.between(0.0, 1.0),
                }
            })
            .collect();
        Self { bodies, touches }
    }

    fn inertia(&self, touch: &Touch) -> [InverseInertia; 2] {
        touch.bodies.map(|body| body.map_or(FIXED, |body| self.bodies[body].inertia))
    }

    /// Rate of a row.
    fn rate(&self, touch: &Touch, jacobian: &[f64; 6]) -> f64 {
        let side = |side: usize| {
            let velocity = touch.bodies[side].map_or([0.0; 3], |body| self.bodies[body].velocity);
            (0..3).map(|k| jacobian[3 * side + k] * velocity[k]).sum::<f64>()
        };
        side(0) + side(1)
    }

    fn load(&self, impact: &mut Impact) {
        let id = |body: Option<usize>| body.map_or(BodyId::WORLD, |body| BodyId(body as u32));
        impact.set_rows(self.touches.iter().map(|touch| {
            let [normal, _] = &touch.jacobians;
            let rate = self.rate(touch, normal);
            let row = CollisionRow::new(touch.bodies.map(id), *normal, self.inertia(touch), rate);
            CollisionRow { elasticity: touch.elasticity, ..row }
        }));
        for (row, touch) in self.touches.iter().enumerate() {
            let [_, tangent] = &touch.jacobians;
            let rate = self.rate(touch, tangent);
            impact.set_friction(row, FrictionRow::new(*tangent, self.inertia(touch), rate, touch.friction));
        }
    }

    /// Kinetic energy [J] before, and after the impulses of an impact.
    fn energies(&self, impact: &Impact) -> [f64; 2] {
        let energy = |bodies: &[Struck]| -> f64 {
            let own = |body: &Struck| {
                let [x, y, w] = body.velocity;
                0.5 * ((x * x + y * y) / body.inertia.inverse_mass + w * w / body.inertia.inverse_moment)
            };
            bodies.iter().map(own).sum()
        };
        let mut bodies = self.bodies.clone();
        for (row, touch) in self.touches.iter().enumerate() {
            let impulses = [impact.impulses()[row], impact.friction_impulse(row)];
            for (jacobian, impulse) in touch.jacobians.iter().zip(impulses) {
                for (side, body) in touch.bodies.iter().enumerate() {
                    let Some(body) = body.map(|body| &mut bodies[body]) else { continue };
                    let InverseInertia { inverse_mass, inverse_moment } = body.inertia;
                    let weights = [inverse_mass, inverse_mass, inverse_moment];
                    for k in 0..3 {
                        body.velocity[k] += weights[k] * jacobian[3 * side + k] * impulse;
                    }
                }
            }
        }
        [energy(&self.bodies), energy(&bodies)]
    }

    /// Resolves by a law, and checks rates, cones and energy.
    fn check(&self, impact: &mut Impact, law: ImpactLaw, restitution: Restitution, name: &str) {
        self.load(impact);
        impact.set_restitution(restitution);
        let outcome = law.resolve(impact, ImpactOrder::Fastest, 0);
        outcome.unwrap_or_else(|error| panic!("{name}, {law:?}: {error}"));
        let [before, after] = self.energies(impact);
        // Rounding is that of the largest impulses, which in a jam are far larger than what is left of them.
        let work = |(row, touch): (usize, &Touch)| {
            let impulses = [impact.impulses()[row], impact.friction_impulse(row)];
            let rates = touch.jacobians.map(|jacobian| self.rate(touch, &jacobian));
            impulses.iter().zip(rates).map(|(impulse, rate)| (impulse * rate).abs()).sum::<f64>()
        };
        let terms = self.touches.iter().enumerate().map(work).sum::<f64>();
        assert!(after <= before + 1e-12 * (before + terms), "{name}, {law:?}: {before} J, then {after} J");
        for (row, touch) in self.touches.iter().enumerate() {
            let (normal, tangential) = (impact.impulses()[row], impact.friction_impulse(row));
            assert!(impact.rates()[row] >= -impact.bound(), "{name}, {law:?}: row {row} closes");
            let least = -1e-12 * (1.0 + normal.abs());
            assert!(normal >= least, "{name}, {law:?}: row {row} pulls with {normal}");
            let room = touch.friction * normal - tangential.abs();
            assert!(room >= least * (1.0 + touch.friction), "{name}, {law:?}: row {row} beyond its cone");
        }
    }
}

#[test]
fn single_impacts_gain_no_energy() {
    let (mut random, mut impact) = (Random::new(3), Impact::new());
    for seed in 0..100_000 {
        let case = Case::random(2, 1, &mut random);
        for restitution in [Restitution::Energetic, Restitution::Poisson] {
            case.check(&mut impact, ImpactLaw::Hybrid, restitution, &format!("case {seed}"));
        }
    }
}

#[test]
fn impacts_of_several_contacts_gain_no_energy_jammed_or_not() {
    let (mut random, mut impact) = (Random::new(5), Impact::new());
    for seed in 0..600 {
        let contacts = random.between(2.0, 13.0) as usize;
        let bodies = random.between(1.0, 5.0) as usize;
        let case = Case::random(bodies, contacts, &mut random);
        let law = LAWS[seed % LAWS.len()];
        case.check(&mut impact, law, Restitution::Energetic, &format!("case {seed}"));
    }
}

#[test]
fn without_friction_the_laws_are_what_they_were() {
    let (mut random, mut rough, mut smooth) = (Random::new(7), Impact::new(), Impact::new());
    for seed in 0..200 {
        let mut case = Case::random(2, 1, &mut random);
        case.touches[0].friction = 0.0;
        case.load(&mut rough);
        smooth.set_rows(rough.rows().to_vec());
        for impact in [&mut rough, &mut smooth] {
            ImpactLaw::Hybrid.resolve(impact, ImpactOrder::Fastest, 0).expect("an impulse");
        }
        let (found, known) = (rough.impulses()[0], smooth.impulses()[0]);
        assert!((found - known).abs() <= 1e-14 * known.abs(), "case {seed}: {found} for {known}");
        assert_eq!(rough.friction_impulse(0), 0.0);
    }
}

/// A disc that falls at 1 m/s between two walls at 20 degrees, rough enough to hold it, which run down at a speed [m/s].
fn wedged(running: f64) -> Impact {
    let mut impact = Impact::new();
    let inertia = [InverseInertia { inverse_mass: 1.0, inverse_moment: 2.0 }, FIXED];
    let tilt = 10.0_f64.to_radians();
    let walls = [[-tilt.cos(), tilt.sin()], [tilt.cos(), tilt.sin()]];
    let bodies = [BodyId(0), BodyId::WORLD];
    let rows = walls.map(|n| {
        let row = CollisionRow::new(bodies, [n[0], n[1], 0.0, 0.0, 0.0, 0.0], inertia, -n[1]);
        CollisionRow { elasticity: 0.5, ..row }
    });
    impact.set_rows(rows);
    for (row, n) in walls.iter().enumerate() {
        let tangent = [-n[1], n[0], -1.0, 0.0, 0.0, 0.0];
        impact.set_friction(row, FrictionRow::new(tangent, inertia, -n[0] * (1.0 - running), 1.0));
    }
    impact
}

#[test]
fn a_wedge_that_jams_stops() {
    // Restitution cannot open both contacts.
    let mut impact = wedged(0.0);
    ImpactLaw::Simultaneous.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("impulses");
    assert!(impact.rates().iter().all(|rate| *rate >= -impact.bound()), "{:?}", impact.rates());
    assert!(impact.friction_loss() > 0.0);
}

#[test]
fn walls_that_draw_a_disc_into_their_wedge_are_told() {
    // No impulse stops what is driven: faster than the disc, it presses it the deeper in the more it is pressed.
    let of_contact = 4_u64;
    for law in LAWS {
        let error = law.resolve(&mut wedged(3.0), ImpactOrder::Fastest, 0).expect_err("there are none");
        assert_eq!(error, ImpactError::DrawnIn { combinations: of_contact * of_contact }, "{law:?}");
    }
}

#[test]
fn a_rod_on_a_pin_strikes_with_what_the_pin_leaves_it() {
    // A rod of 1 kg and 2 m, pinned at its upper end, strikes a wall with its lower end: of its motion only the turn is
    // left, which a normal through the end stops like a mass of 1/3 kg. Friction acts along the rod, on the pin.
    let mut impact = Impact::new();
    let inertia = [InverseInertia { inverse_mass: 1.0, inverse_moment: 3.0 }, FIXED];
    let bodies = [BodyId(0), BodyId::WORLD];
    let pin = [[1.0, 0.0, -1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]];
    let velocity = [1.0, 0.0, 1.0];
    let rate = |j: &[f64; 6]| (0..3).map(|k| j[k] * velocity[k]).sum::<f64>();
    let normal = [-1.0, 0.0, -1.0, 0.0, 0.0, 0.0];
    let row = |j: [f64; 6]| CollisionRow::new(bodies, j, inertia, rate(&j));
    let contact = CollisionRow { elasticity: 0.5, ..row(normal) };
    let held = pin.map(|j| CollisionRow { kind: RowKind::Bilateral, ..row(j) });
    impact.set_rows([contact, held[0], held[1]]);
    let tangent = [0.0, -1.0, 0.0, 0.0, 0.0, 0.0];
    impact.set_friction(0, FrictionRow::new(tangent, inertia, 0.0, 0.3));
    ImpactLaw::Hybrid.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("impulses");
    assert!((impact.impulses()[0] - 1.5 * 2.0 / 3.0).abs() < 1e-12, "{:?}", impact.impulses());
    assert!((impact.rates()[0] - 1.0).abs() < 1e-12 && impact.rates()[1].abs() < 1e-12);
    assert_eq!(impact.friction_impulse(0), 0.0);
}

#[test]
fn numbers_that_are_none_are_refused() {
    let mut impact = Impact::new();
    let inertia = [InverseInertia { inverse_mass: 1.0, inverse_moment: 2.0 }, FIXED];
    let jacobian = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    impact.set_rows([CollisionRow::new([BodyId(0), BodyId::WORLD], jacobian, inertia, -1.0)]);
    impact.set_friction(0, FrictionRow::new([1.0, 0.0, 0.5, 0.0, 0.0, 0.0], inertia, 0.2, -0.5));
    let error = ImpactLaw::Hybrid.resolve(&mut impact, ImpactOrder::Fastest, 0).expect_err("it is none");
    assert!(matches!(error, ImpactError::BadRow { row: 0, .. }), "{error}");
}

#[test]
fn what_contacts_were_unloaded_by_comes_back_with_friction() {
    // A disc of 1 kg that slides and opens a little, but is pressed down by more than that.
    let inertia = [InverseInertia { inverse_mass: 1.0, inverse_moment: 8.0 }, FIXED];
    let bodies = [BodyId(0), BodyId(1)];
    let (opens, carried, slip) = (1e-3, 5e-3, 2.0);
    let row = CollisionRow::new(bodies, [0.0, 1.0, 0.0, 0.0, -1.0, 0.0], inertia, opens);
    for (coefficient, expected) in [(0.0, 0.0), (0.3, 0.3)] {
        let mut impact = Impact::new();
        impact.set_rows([row]);
        impact
            .set_friction(0, FrictionRow::new([-1.0, 0.0, -0.5, 1.0, 0.0, 0.0], inertia, slip, coefficient));
        impact.unload(&[carried]);
        impact.try_inelastic().expect("one contact");
        // It comes to rest by what it opened, less than it carried.
        assert!(impact.rates()[0].abs() < 1e-12, "{:?}", impact.rates());
        assert!((impact.impulses()[0] + opens).abs() < 1e-12, "{:?}", impact.impulses());
        let pressed = carried - opens;
        assert!((impact.friction_impulse(0) + expected * pressed).abs() < 1e-12, "{coefficient}");
        let slowed = slip - expected * pressed * (1.0 + 8.0 * 0.25);
        assert!((impact.slip_speed(0) - slowed).abs() < 1e-12, "{coefficient}: {}", impact.slip_speed(0));
    }
}
