//! A warm solve of a known size allocates nothing.
#![allow(unsafe_code, reason = "counting allocations takes a global allocator, and that is an unsafe trait")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use halfgap_contact::{
    ActiveRows, Auto, CollisionRow, ContactKey, DualActiveSet, Impact, ImpactLaw, ImpactOrder,
    InverseInertia, Method, Problem, ProblemBody, ProximalNewton, Row, RowKind, Solution, Solver, WarmStart,
};

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// Passes everything to the system and counts the calls of this thread.
struct Counting;

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promises are those that the system's allocator needs.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Fills `problem` with a stack of boxes on the floor at one step: the offsets differ from step to step.
fn fill(problem: &mut Problem, boxes: usize, step: usize) {
    problem.clear();
    for i in 0..boxes {
        problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 12.0 }).unwrap();
        for (corner, arm) in [(0, -0.5), (1, 0.5)] {
            let wobble = 1e-3 * ((7 * i + 3 * step + 5 * corner) % 11) as f64;
            let offset = if i == 0 { -9.81 } else { 0.0 };
            let row = Row::new(ProblemBody(i as u32), [0.0, 1.0, arm], offset - wobble);
            let row = if i == 0 { row } else { row.against(ProblemBody(i as u32 - 1), [0.0, -1.0, -arm]) };
            problem.add_row(&row.with_key(ContactKey((2 * i + corner) as u64))).unwrap();
        }
    }
}

/// Allocations while a problem is filled and solved warm, after steps that made all the room.
fn allocations(solver: &mut dyn Solver, boxes: usize) -> usize {
    let (mut problem, mut solution, mut warm) = (Problem::new(), Solution::new(), WarmStart::new());
    fill(&mut problem, boxes, 0);
    solver.solve(&problem, &mut solution).unwrap();
    warm.remember(&problem, &solution);
    let mut before = 0;
    for step in 1..20 {
        if step == 10 {
            before = COUNT.with(Cell::get);
        }
        fill(&mut problem, boxes, step);
        solver.solve_from(&problem, &warm, &mut solution).unwrap();
        warm.remember(&problem, &solution);
    }
    COUNT.with(Cell::get) - before
}

#[test]
fn a_warm_solve_of_known_size_allocates_nothing() {
    for boxes in [1, 5, 50, 200] {
        assert_eq!(allocations(&mut DualActiveSet::default(), boxes), 0, "dual active set, {boxes} boxes");
        assert_eq!(allocations(&mut ProximalNewton::default(), boxes), 0, "proximal method, {boxes} boxes");
        assert_eq!(allocations(&mut Auto::default(), boxes), 0, "automatic choice, {boxes} boxes");
    }
}

#[test]
fn a_warm_solve_with_friction_allocates_nothing() {
    let (mut problem, mut solution, mut warm) = (Problem::new(), Solution::new(), WarmStart::new());
    let (mut auto, mut before) = (Auto::default(), 0);
    for step in 0..20 {
        problem.clear();
        for i in 0..8 {
            let body = problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 12.0 }).unwrap();
            for arm in [-0.5, 0.5] {
                let offset = if i == 0 { -9.81 } else { 0.0 } - 1e-3 * f64::from((7 * i + 3 * step) % 11);
                let rows = [Row::new(body, [0.0, 1.0, arm], offset), Row::new(body, [-1.0, 0.0, -0.5], 1e-2)];
                let [gap, slip] = if i == 0 {
                    rows
                } else {
                    let below = ProblemBody(i as u32 - 1);
                    [rows[0].against(below, [0.0, -1.0, -arm]), rows[1].against(below, [1.0, 0.0, -0.5])]
                };
                problem.add_contact(&gap, &slip, 0.4).unwrap();
            }
        }
        if step == 10 {
            before = COUNT.with(Cell::get);
        }
        match step {
            0 => auto.solve(&problem, &mut solution).unwrap(),
            _ => auto.solve_from(&problem, &warm, &mut solution).unwrap(),
        }
        warm.remember(&problem, &solution);
    }
    assert_eq!(COUNT.with(Cell::get) - before, 0);
}

/// Fills `problem` with boxes in a pyramid of the given number of layers at one step, each box of its own width:
/// contacts that nearly depend on each other take many pivots, and are handed over.
fn fill_crooked(problem: &mut Problem, layers: usize, step: usize) {
    problem.clear();
    let (mut first_below, mut bodies) = (0, 0);
    let mut width = (0..).map(|k| 0.5 * (1.0 + 1e-3 * (1.7 * k as f64 + step as f64).sin()));
    let mut width = || width.next().unwrap_or(0.5);
    for layer in 0..layers {
        let first = bodies;
        for k in 0..layers - layer {
            let body = problem.add_body(InverseInertia { inverse_mass: 0.8, inverse_moment: 3.0 }).unwrap();
            bodies += 1;
            if layer == 0 {
                for side in [-width(), width()] {
                    problem.add_row(&Row::new(body, [0.0, 1.0, side], -9.81)).unwrap();
                }
                continue;
            }
            for (other, lower, upper) in
                [(k, 0.0, -1.0), (k, 1.0, 0.0), (k + 1, -1.0, 0.0), (k + 1, 0.0, 1.0)]
            {
                let row = Row::new(body, [0.0, width(), upper * width()], 0.0);
                let below = ProblemBody((first_below + other) as u32);
                problem.add_row(&row.against(below, [0.0, -width(), -lower * width()])).unwrap();
            }
        }
        first_below = first;
    }
}

#[test]
fn contacts_that_are_handed_over_allocate_nothing_either() {
    let (mut problem, mut solution, mut solver) = (Problem::new(), Solution::new(), Auto::default());
    let mut before = 0;
    for step in 0..20 {
        if step == 10 {
            before = COUNT.with(Cell::get);
        }
        fill_crooked(&mut problem, 10, step % 2);
        solver.solve(&problem, &mut solution).unwrap();
        assert_eq!(solution.method, Method::ProximalNewton);
    }
    assert_eq!(COUNT.with(Cell::get) - before, 0);
}

/// The rows of a stack of boxes with two pins beside it, which closes at a speed that differs from step to step.
fn impact_rows(boxes: u32, step: u32) -> impl Iterator<Item = CollisionRow> {
    let world = halfgap_collision::BodyId::WORLD;
    let inertia = |body: halfgap_collision::BodyId| {
        let moves = f64::from(u8::from(!body.is_world()));
        InverseInertia { inverse_mass: moves, inverse_moment: 12.0 * moves }
    };
    (0..2 * boxes).map(move |row| {
        let upper = halfgap_collision::BodyId(row / 2);
        let lower = if row < 2 { world } else { halfgap_collision::BodyId(row / 2 - 1) };
        let arm = if row % 2 == 0 { -0.5 } else { 0.5 };
        let rate = if row < 2 { -1.0 - 0.1 * f64::from(step % 3) } else { 0.0 };
        let jacobian = [0.0, 1.0, arm, 0.0, -1.0, -arm];
        let bilateral = row % 5 == 4;
        CollisionRow {
            elasticity: 0.5,
            velocity_tol: 1e-9,
            kind: RowKind::plain(bilateral),
            ..CollisionRow::new([upper, lower], jacobian, [upper, lower].map(inertia), rate)
        }
    })
}

#[test]
fn a_warm_impact_of_known_size_allocates_nothing() {
    let laws =
        [ImpactLaw::Simultaneous, ImpactLaw::Hybrid, ImpactLaw::SerialSeparate, ImpactLaw::SerialGrouped];
    for law in laws {
        let mut impact = Impact::new();
        let mut before = 0;
        for step in 0..12 {
            if step == 6 {
                before = COUNT.with(Cell::get);
            }
            impact.set_rows(impact_rows(10, step));
            law.resolve(&mut impact, ImpactOrder::Fastest, 0).unwrap();
            impact.set_rows(impact_rows(10, step));
            impact.resolve_inelastic().unwrap();
        }
        assert_eq!(COUNT.with(Cell::get) - before, 0, "{law:?}");
    }
}

#[test]
fn active_rows_of_known_size_allocate_nothing() {
    let inertia = [InverseInertia { inverse_mass: 1.0, inverse_moment: 12.0 }; 30];
    let rows: Vec<[Option<u32>; 2]> =
        (0..60u32).map(|row| [Some(row / 2), (row / 2).checked_sub(1)]).collect();
    let arm = |row: usize| if row.is_multiple_of(2) { [1.0, 0.0, 0.1] } else { [0.0, 1.0, 0.5] };
    let jacobians: Vec<[f64; 6]> = (0..60).map(arm).map(|[x, y, turn]| [x, y, turn, -x, -y, turn]).collect();
    let (mut force, mut change) = ([0.0; 60], [[0.0; 3]; 30]);
    let mut active = ActiveRows::default();
    let mut before = 0;
    for step in 0..4 {
        if step == 2 {
            before = COUNT.with(Cell::get);
        }
        // Fewer rows in between, so that the structure is found anew.
        for count in [60, 20] {
            active.set_structure(&inertia, &rows[..count]);
            active.factorize(&jacobians[..count]);
            active.solve(&[-1.0; 60][..count], &mut force[..count]);
            active.respond(&force[..count], &mut change);
        }
    }
    assert_eq!(COUNT.with(Cell::get) - before, 0);
}
