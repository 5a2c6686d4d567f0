//! Kinds of rows: what is accepted, and what each method refuses by name.

#[cfg(feature = "qp")]
use halfgap_contact::Qp;
use halfgap_contact::collision::BodyId;
use halfgap_contact::{
    Auto, CollisionRow, DualActiveSet, Impact, ImpactError, ImpactLaw, ImpactOrder, InverseInertia, Lemke,
    Method, Modes, Problem, ProblemBody, ProblemError, ProximalNewton, Row, RowKind, Settings, Solution,
    SolveError, Solver,
};

const NORMAL: [f64; 3] = [0.0, 1.0, 0.1];
const ALONG: [f64; 3] = [1.0, 0.0, 0.5];
const BLOCK: InverseInertia = InverseInertia { inverse_mass: 0.5, inverse_moment: 2.0 };

/// A block on one contact, and the row of that.
fn block() -> (Problem, ProblemBody, usize) {
    let mut problem = Problem::new();
    let body = problem.add_body(BLOCK).expect("a fine inertia");
    let contact = problem.add_row(&Row::new(body, NORMAL, -9.81)).expect("a fine row");
    (problem, body, contact)
}

fn solvers() -> Vec<Box<dyn Solver>> {
    let settings = Settings::default();
    vec![
        Box::new(Auto::new(settings).expect("fine settings")),
        Box::new(DualActiveSet::new(settings).expect("fine settings")),
        Box::new(ProximalNewton::new(settings).expect("fine settings")),
        Box::new(Lemke::new(settings).expect("fine settings")),
        Box::new(Modes::new(settings).expect("fine settings")),
        #[cfg(feature = "qp")]
        Box::new(Qp::new(settings).expect("fine settings")),
    ]
}

#[test]
fn a_row_keeps_its_kind_and_the_direction_of_its_force() {
    let (mut problem, body, contact) = block();
    let rows = [
        Row::new(body, ALONG, 0.0).bilateral(),
        Row::new(body, ALONG, 0.0).bounded(-2.0, f64::INFINITY),
        Row::new(body, ALONG, 0.0).friction(contact, 0.4),
        Row::new(body, ALONG, 0.0).with_force(NORMAL, [0.0; 3]),
        Row::new(body, ALONG, 0.0).with_force(ALONG, [0.0; 3]),
    ];
    let added: Vec<_> = rows.iter().map(|row| problem.add_row(row).expect("a fine row")).collect();
    assert_eq!(problem.kind(contact), RowKind::Unilateral);
    let kinds: Vec<_> = added.iter().map(|&row| problem.kind(row)).collect();
    assert_eq!(kinds, rows.map(|row| row.kind));
    assert_eq!(problem.bilateral(), [false, true, false, false, false, false]);
    // A force along what is measured is no direction of its own.
    let turned: Vec<_> = added.iter().map(|&row| problem.force_direction(row)).collect();
    assert_eq!(turned, [None, None, None, Some([NORMAL, [0.0; 3]]), None]);
    assert!(!problem.is_plain());
    problem.clear();
    assert!(problem.is_plain());
}

#[test]
fn bounds_that_are_none_are_refused() {
    let (mut problem, body, contact) = block();
    let before = problem.clone();
    let mut error = |row: &Row| problem.add_row(row).expect_err("it is none");
    let row = Row::new(body, ALONG, 0.0);
    assert_eq!(error(&row.bounded(1.0, -1.0)), ProblemError::BadBounds { row: 1, least: 1.0, most: -1.0 });
    assert!(matches!(error(&row.bounded(f64::NAN, 1.0)), ProblemError::BadBounds { row: 1, .. }));
    assert_eq!(error(&row.friction(contact, -0.1)), ProblemError::BadFriction { row: 1, coefficient: -0.1 });
    assert!(matches!(error(&row.friction(contact, f64::NAN)), ProblemError::BadFriction { row: 1, .. }));
    assert_eq!(error(&row.friction(1, 0.1)), ProblemError::NotAContact { row: 1, normal: 1 });
    let infinite = error(&row.with_force([f64::INFINITY, 0.0, 0.0], [0.0; 3]));
    assert_eq!(infinite.to_string(), "row 1: a coefficient of the force is inf");
    assert_eq!(problem, before);
    problem.add_row(&row.bilateral()).expect("a fine row");
    let on_connector = problem.add_row(&row.friction(1, 0.1)).expect_err("a connector is no contact");
    assert_eq!(on_connector.to_string(), "row 2: friction needs a unilateral row before it, row 1 is none");
}

#[test]
fn symmetric_methods_refuse_kinds_that_they_do_not_take_by_name() {
    let (plain, body, contact) = block();
    let row = Row::new(body, ALONG, 0.0);
    let further = [
        (row.bounded(-1.0, 1.0), "a row bounded by constants"),
        (row.friction(contact, 0.3), "a row bounded by friction"),
        (row.with_force(NORMAL, [0.0; 3]), "a row whose force acts in another direction than is measured"),
    ];
    for (row, words) in further {
        let mut problem = plain.clone();
        problem.add_row(&row).expect("a fine row");
        for mut solver in solvers() {
            let (method, outcome) = (solver.method(), solver.solve(&problem, &mut Solution::new()));
            if matches!(method, Method::Auto | Method::Lemke | Method::Modes) {
                outcome.unwrap_or_else(|error| panic!("{method}, {words}: {error}"));
                continue;
            }
            let error = outcome.expect_err("it is not taken");
            assert_eq!(error, SolveError::UnsupportedRow { method, row: 1, kind: words });
            assert_eq!(error.to_string(), format!("{method} does not take {words}: row 1 is one"));
            solver.solve(&plain, &mut Solution::new()).expect("without the row it is solved");
        }
    }
}

#[test]
fn a_kind_can_be_set_where_it_fits() {
    let mut problem = Problem::from_dense(&[vec![2.0, 0.5], vec![0.5, 1.0]], &[-1.0, 0.3]).expect("a matrix");
    let friction = RowKind::Friction { normal: 0, coefficient: 0.4 };
    problem.set_kind(1, friction).expect("a fine row");
    assert_eq!(problem.kind(1), friction);
    let error = problem.set_kind(0, RowKind::Bilateral).expect_err("friction needs it");
    assert_eq!(error, ProblemError::NotAContact { row: 1, normal: 0 });
    let on_itself = RowKind::Friction { normal: 0, coefficient: 0.4 };
    assert_eq!(problem.set_kind(0, on_itself), Err(ProblemError::NotAContact { row: 0, normal: 0 }));
    problem.set_kind(1, RowKind::Unilateral).expect("a fine row");
    assert!(problem.is_plain());
}

#[test]
fn impact_laws_refuse_kinds_that_they_do_not_take() {
    let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
    let jacobian = [0.0, 1.0, 0.0, 0.0, -1.0, 0.0];
    let row = CollisionRow::new([BodyId(0), BodyId::WORLD], jacobian, [BLOCK, fixed], -1.0);
    let mut impact = Impact::new();
    impact.set_rows([row, CollisionRow { kind: RowKind::Bounded { least: -1.0, most: 1.0 }, ..row }]);
    let outcome = ImpactLaw::Simultaneous.resolve(&mut impact, ImpactOrder::Fastest, 0);
    let rule = "impact laws take unilateral and bilateral rows only";
    assert_eq!(outcome, Err(ImpactError::BadRow { row: 1, rule }));
}
