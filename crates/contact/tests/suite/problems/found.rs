//! Problems that were once solved wrongly, found by trials of many problems of one family.

use halfgap_contact::{
    Auto, DualActiveSet, InverseInertia, Lemke, Problem, Row, Solution, SolveError, Solver,
};

use super::data::{Case, Judged, disproof, judge};

/// The answer of a solver to a problem, and the quality of the answer.
fn solved(solver: &mut dyn Solver, name: &str) -> (Solution, Judged) {
    let case = Case::found(name);
    let mut solution = Solution::new();
    solver.solve(&case.problem, &mut solution).unwrap_or_else(|error| panic!("{name}: {error}"));
    let judged = judge(&case.problem, &solution.force);
    (solution, judged)
}

#[test]
fn solvable_problems_that_were_called_infeasible_are_solved() {
    for name in [
        "crowded_bodies_64",
        "struck_wall",
        "bodies_with_joints_141",
        "stack_of_mass_ratio_1e12",
        "two_pins_2e-8_apart_kicked",
        "two_bodies_two_pins_1e-4_apart",
        "ring_of_three_off_by_1e-5",
        "truss_of_9_rods_kicked",
        "linear_program_of_rows_far_apart",
        // Bodies are met in another order than their numbers, which the proximal method did not expect.
        "islands_of_66_rows",
    ] {
        let (_, judged) = solved(&mut Auto::default(), name);
        assert!(judged.good(), "{name}: {judged:?}");
    }
}

/// Solves a problem by the automatic choice, and requires that the answer is exact to rounding, with modest forces.
fn require_modest(name: &str) {
    let (solution, judged) = solved(&mut Auto::default(), name);
    assert!(judged.growth < 1e3 && judged.natural <= 1e-12, "{name}: {judged:?}");
    assert_eq!(solution.inconsistency, 0.0, "{name}");
}

#[test]
fn forces_of_jammed_bodies_are_modest() {
    // The bodies may press each other by any amount, and the middle of all those forces lies beyond all bounds.
    for name in ["discs_jammed_under_a_lid", "eight_bodies_160_contacts"] {
        require_modest(name);
    }
}

#[test]
fn a_contact_holds_what_two_pins_at_one_place_would_hold_by_huge_forces() {
    // No force of the pins turns the block, and it rests on its other end.
    for name in ["two_pins_3e-8_apart", "two_pins_1e-8_apart"] {
        require_modest(name);
        let (solution, _) = solved(&mut DualActiveSet::default(), name);
        let resting = solution.force[4];
        assert!((resting - 4.905).abs() < 1e-6, "{name}: {resting} N");
        assert!(solution.acceleration.iter().all(|a| a.abs() < 1e-10), "{:?}", solution.acceleration);
    }
}

#[test]
fn rows_that_take_each_others_place_for_little_are_left_at_it_for_a_while() {
    let (_, judged) = solved(&mut DualActiveSet::default(), "brick_wall_off_by_1e-9");
    assert!(judged.good() && judged.growth < 100.0, "{judged:?}");
}

#[test]
fn contacts_that_contradict_each_other_by_rounding_are_made_to_agree_once() {
    for name in ["gears_20", "gears_98"] {
        let (solution, judged) = solved(&mut DualActiveSet::default(), name);
        assert!(judged.good() && solution.inconsistency < 1e-12, "{name}: {judged:?}");
        assert!(solution.iterations < 50, "{name}: {} pivots", solution.iterations);
    }
}

#[test]
fn problems_that_take_more_digits_than_usual_are_solved() {
    for name in ["truss_of_9_rods", "ropes_nearly_parallel", "block_jammed_in_a_pit"] {
        let (_, judged) = solved(&mut Auto::default(), name);
        assert!(judged.growth < 1e9 && judged.backward <= 1e-14, "{name}: {judged:?}");
    }
}

#[test]
fn unsymmetric_problems_are_solved_whatever_their_units_and_growth() {
    for name in [
        "friction_in_a_scissor_mass_ratio_1e6",
        "unsymmetric_redundant_truss",
        "klee_minty_8",
        "skew_matrix_of_1e12",
        "csizmadia_32",
    ] {
        let (_, judged) = solved(&mut Lemke::default(), name);
        assert!(judged.good(), "{name}: {judged:?}");
    }
}

#[test]
fn doubled_joints_of_unsymmetric_problems_are_solved_by_least_squares() {
    let (solution, judged) = solved(&mut Auto::default(), "unsymmetric_doubled_joint_off_by_1e-9");
    assert!((solution.inconsistency - 5e-10).abs() < 1e-12, "{:e}", solution.inconsistency);
    assert!(judged.natural - solution.inconsistency <= 1e-12, "{judged:?}");
}

#[test]
fn joints_that_nearly_depend_on_each_other_are_solved_by_least_squares() {
    for name in ["contact_on_contradicting_joints", "nearly_dependent_truss", "nearly_dependent_bridge"] {
        let (solution, judged) = solved(&mut Auto::default(), name);
        assert!(solution.inconsistency <= 1e-8, "{name}: {:e}", solution.inconsistency);
        assert!(
            judged.growth < 1e3 && judged.natural - solution.inconsistency <= 1e-12,
            "{name}: {judged:?}"
        );
    }
}

#[test]
fn a_ray_made_by_rounding_is_no_proof() -> Result<(), Box<dyn std::error::Error>> {
    // Two contacts with forces of 1e4 and 1e5, one of them of a light body with a moment far too small for
    // it, and a joint.
    let inverse_mass = [9145.108044063347, 9145.108044063347, 0.00012616026371794375];
    let rows = [
        [-20.07996482141255, 22.59873375924099, -29.236885047095612],
        [0.07062260208885474, 0.039761572465652095, -0.05303438859690081],
        [0.0008949073315673381, -0.019689927287867125, 0.0193061575675774],
    ];
    let triplets: Vec<_> =
        (0..3).flat_map(|row| (0..3).map(move |column| (row, column, rows[row][column]))).collect();
    let offset = [67.4650371517092, 0.05020061840013432, -0.04862678856871801];
    let mut problem = Problem::from_rows(&triplets, &inverse_mass, &offset)?;
    problem.set_bilateral(&[true, false, false])?;
    let mut solution = Solution::new();
    Auto::default().solve(&problem, &mut solution)?;
    assert!(solution.force[2] > 1e5, "{:?}", solution.force);
    // The pivots of Lemke's method may miss the forces, but must not claim that there are none.
    let outcome = Lemke::default().solve(&problem, &mut solution);
    assert!(!matches!(outcome, Err(SolveError::Infeasible(_))), "{outcome:?}");
    Ok(())
}

#[test]
fn a_row_that_rounding_left_out_of_the_basis_is_taken_in() {
    let (_, judged) = solved(&mut Lemke::default(), "parallel_rows_at_a_tie");
    assert!(judged.good(), "{judged:?}");
}

#[test]
fn problems_without_a_solution_are_proven_infeasible() {
    for name in [
        "doubled_joint_off_by_1e-4",
        "contradicting_matrix_35",
        "two_pins_askew_by_1e-5",
        "five_blocks_squeezed",
        "four_blocks_squeezed_mass_ratio_1e9",
        "joints_squeezed_mass_ratio_1e9",
        "two_blocks_squeezed_mass_ratio_1e6",
        "pit_mass_ratio_1e9",
        "unsymmetric_doubled_joint_off_by_1e-7",
        // Beyond the size at which more digits are tried.
        "discs_jammed_in_a_box",
    ] {
        let case = Case::found(name);
        let mut solution = Solution::new();
        match Auto::default().solve(&case.problem, &mut solution) {
            Err(SolveError::Infeasible(proof)) => {
                assert_eq!(disproof(&case.problem, &proof.direction), None, "{name}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}

/// A problem with a number of discs at rest on a floor before its rows.
fn beside_discs(name: &str, discs: usize, offset: f64) -> Problem {
    let mut file = Case::found(name).file;
    let rows = file.j.as_mut().unwrap();
    rows.triplets.iter_mut().for_each(|(row, column, _)| (*row, *column) = (*row + discs, *column + discs));
    rows.triplets.extend((0..discs).map(|disc| (disc, disc, 1.0)));
    (rows.rows, rows.columns) = (rows.rows + discs, rows.columns + discs);
    file.inverse_mass.as_mut().unwrap().splice(0..0, vec![1.0; discs]);
    file.bilateral.as_mut().unwrap().splice(0..0, vec![false; discs]);
    file.b.splice(0..0, vec![offset; discs]);
    file.problem().unwrap()
}

#[test]
fn a_problem_without_a_solution_has_none_beside_other_bodies() {
    let (name, mut solution) = ("nine_rows_of_whole_numbers", Solution::new());
    for discs in [0, 24, 35, 39, 100] {
        let problem = beside_discs(name, discs, -1.0);
        match Auto::default().solve(&problem, &mut solution) {
            Err(SolveError::Infeasible(proof)) => {
                assert_eq!(disproof(&problem, &proof.direction), None, "{discs} discs");
                assert!(
                    proof.row >= discs && proof.direction[..discs].iter().all(|z| *z == 0.0),
                    "{proof:?}"
                );
                // Digits that are not returned do not count.
                assert!((1e-17..1e-15).contains(&proof.leakage), "{proof:?}");
            }
            other => panic!("{discs} discs: {other:?}"),
        }
        // Beside offsets as large as these the contradiction is rounding.
        let problem = beside_discs(name, discs + 1, -1e9);
        Auto::default().solve(&problem, &mut solution).unwrap();
    }
}

#[test]
fn a_doubtful_verdict_on_an_island_does_not_stand_against_a_solution() {
    let (_, judged) = solved(&mut Auto::default(), "stacks_of_masses_1e12_apart");
    assert!(judged.growth < 1e8 && judged.backward <= 1e-14, "{judged:?}");
}

/// Two bodies held together by two pins on a line at an angle to the y axis, whose four rows hold three motions. The
/// offsets follow from some accelerations, and one of the pins is off along the line.
fn two_pins(angle: f64, off: f64) -> Problem {
    let mut problem = Problem::new();
    let bodies = [(3.4, 67.3), (1.7, 9.9)].map(|(inverse_mass, inverse_moment)| {
        problem.add_body(InverseInertia { inverse_mass, inverse_moment }).unwrap()
    });
    let along = [-angle.sin(), angle.cos()];
    for side in [-0.4, 0.4] {
        let [x, y] = along.map(|part| side * part);
        // Arms to the same two points, from a centre half a metre to either side.
        for (direction, arms, offset) in
            [([1.0, 0.0], [-y, -y], 0.3 - 0.9 * y), ([0.0, 1.0], [x - 0.5, x + 0.5], -0.7 + 0.9 * x)]
        {
            let off =
                if side > 0.0 { off * (direction[0] * along[0] + direction[1] * along[1]) } else { 0.0 };
            let [u, v] = direction;
            let row = Row::new(bodies[0], [u, v, arms[0]], offset + off);
            problem.add_row(&row.against(bodies[1], [-u, -v, -arms[1]]).bilateral()).unwrap();
        }
    }
    problem
}

#[test]
fn two_pins_that_hold_the_same_are_solved_or_contradict_each_other_however_they_lie() {
    let (mut solver, mut solution) = (Auto::default(), Solution::new());
    for k in 0..=1200 {
        let angle = std::f64::consts::FRAC_PI_2 * 10f64.powf(-0.01 * f64::from(k));
        for angle in [angle, std::f64::consts::FRAC_PI_2 - angle, -angle] {
            for off in [0.0, 1e-13] {
                let solved = solver.solve(&two_pins(angle, off), &mut solution);
                assert!(solved.is_ok() && solution.inconsistency <= 1e-8, "{angle}, {off}: {solved:?}");
            }
            // A contradiction of less than a hundredth of 1e-4, times the reciprocal of what rounding leaves of A, may
            // pass for forces.
            let problem = two_pins(angle, 1e-4);
            match solver.solve(&problem, &mut solution) {
                Err(SolveError::Infeasible(proof)) => {
                    assert_eq!(disproof(&problem, &proof.direction), None, "{angle}");
                }
                other => panic!("{angle}: {other:?}"),
            }
        }
    }
}

/// The next of a sequence of numbers from 0 to 1, the same for the same seed: Weyl's, mixed.
fn next(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mixed = (*state ^ (*state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Contacts in all directions among few bodies, with offsets that some forces f ≥ 0 just undo where they act.
fn crowd(seed: u64) -> Problem {
    let mut state = seed;
    let mut random = || next(&mut state);
    let rows = 64 + (random() * 100.0) as usize;
    let count = 1 + (random() * rows as f64) as usize;
    let mut problem = Problem::new();
    let bodies: Vec<_> = (0..count)
        .map(|_| InverseInertia { inverse_mass: 0.1 + random(), inverse_moment: 0.1 + 6.0 * random() })
        .map(|inertia| problem.add_body(inertia).unwrap())
        .collect();
    for _ in 0..rows {
        let angle = std::f64::consts::TAU * random();
        let [a, b] = [0, 1].map(|_| (random() * count as f64) as usize);
        let row = Row::new(bodies[a], [angle.cos(), angle.sin(), random() - 0.5], 0.0);
        let other = [-angle.cos(), -angle.sin(), random() - 0.5];
        problem.add_row(&if a == b { row } else { row.against(bodies[b], other) }).unwrap();
    }
    let share = random();
    let force: Vec<f64> = (0..rows).map(|_| if random() < share { random() } else { 0.0 }).collect();
    let offset: Vec<f64> = problem
        .dense()
        .iter()
        .zip(&force)
        .map(|(row, own)| {
            let pushed: f64 = row.iter().zip(&force).map(|(a, f)| a * f).sum();
            if *own > 0.0 { -pushed } else { random() - pushed }
        })
        .collect();
    problem.set_offset(&offset).unwrap();
    problem
}

#[test]
fn crowds_of_bodies_are_solved() {
    let (mut solver, mut solution) = (Auto::default(), Solution::new());
    for seed in 0..300 {
        let problem = crowd(seed);
        solver.solve(&problem, &mut solution).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let judged = judge(&problem, &solution.force);
        assert!(judged.good(), "seed {seed}, {} rows: {judged:?}", problem.len());
    }
}

#[test]
fn numbers_beyond_what_can_be_computed_with_are_refused_by_row() {
    let inertia = InverseInertia { inverse_mass: 1.0, inverse_moment: 1.0 };
    for size in [1e-170, 1e170] {
        let mut problem = Problem::new();
        let body = problem.add_body(inertia).unwrap();
        problem.add_row(&Row::new(body, [1.0, 0.0, 0.0], -1.0)).unwrap();
        let error = problem.add_row(&Row::new(body, [size, 0.0, 0.0], -1.0)).unwrap_err();
        assert!(error.to_string().starts_with("row 1: its diagonal entry of A is"), "{error}");
        assert_eq!(problem.len(), 1);
        Auto::default().solve(&problem, &mut Solution::new()).unwrap();
        let error = Problem::from_rows(&[(0, 0, size)], &[1.0], &[-1.0]).unwrap_err();
        assert!(error.to_string().starts_with("row 0: its diagonal entry of A is"), "{error}");
    }
    // The force would be 1e315 N.
    let problem = Problem::from_rows(&[(0, 0, 1e-150)], &[1e-5], &[-1e10]).unwrap();
    for solver in [&mut Auto::default() as &mut dyn Solver, &mut Lemke::default()] {
        let outcome = solver.solve(&problem, &mut Solution::new());
        assert!(matches!(outcome, Err(SolveError::Unsolved { .. })), "{outcome:?}");
    }
    let error = Problem::from_dense(&[vec![0.0, 1.0], vec![1.0, 0.0]], &[-1.0, -1.0]).unwrap_err();
    assert!(error.to_string().contains("not positive semidefinite"), "{error}");
    let error = Problem::from_dense(&[vec![1.0, 2.0], vec![2.0, 1.0]], &[-1.0, -1.0]).unwrap_err();
    assert!(error.to_string().contains("not positive semidefinite"), "{error}");
}
