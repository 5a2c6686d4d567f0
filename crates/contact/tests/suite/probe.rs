use halfgap_contact::*;
use crate::data::{collection, judge};
#[test]
fn probe() {
    let mut solver = ProximalNewton::default();
    let mut das = DualActiveSet::default();
    let mut solution = Solution::new();
    for case in collection().iter().filter(|case| case.problem.has_bodies()) {
        let t = std::time::Instant::now();
        let _ = das.solve(&case.problem, &mut solution);
        let t0 = t.elapsed().as_secs_f64() * 1e6;
        let t = std::time::Instant::now();
        let r = solver.solve(&case.problem, &mut solution);
        let t = t.elapsed().as_secs_f64() * 1e6;
        let t2 = std::time::Instant::now();
        let r = solver.solve(&case.problem, &mut solution);
        let t2 = t2.elapsed().as_secs_f64() * 1e6;
        let mut warm = WarmStart::new(); warm.remember(&case.problem, &solution);
        let t3 = std::time::Instant::now();
        let r = solver.solve_from(&case.problem, &warm, &mut solution);
        let t3 = t3.elapsed().as_secs_f64() * 1e6;
        let j = judge(&case.problem, &solution.force);
        let ok = r.is_ok() && j.good();
        if ok != case.feasible() || case.problem.len() > 90 {
        println!("{} n {} feas {} das {t0:.0} prox {t:.0} again {t2:.0} warm {t3:.0} us it {} {} {j:?}", case.name, case.problem.len(), case.feasible(), solution.iterations, match r { Ok(()) => "ok".to_owned(), Err(e) => e.to_string()}); }
    }
}
