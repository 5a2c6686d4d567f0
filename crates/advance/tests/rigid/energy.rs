//! Energy and momentum over thousands of events.

use crate::box_of_bodies::*;
use halfgap_advance::Time;
use halfgap_advance::advance_until;

#[test]
fn fifty_elastic_discs_keep_their_energy_over_thousands_of_impacts() {
    let mut system = system(discs_in_a_box(50, &mut Random(1)));
    let before = energy(&system, 0.0);
    advance(&mut system, 200.0).expect("impacts of few rows");
    let counts = system.counts();
    assert!(counts.impacts > 5000, "{} impacts", counts.impacts);
    let after = energy(&system, 200.0);
    assert!((after / before - 1.0).abs() < 1e-12, "{} of the energy is left", after / before);
    let gap = counts.smallest_gap.expect("there were impacts");
    assert!(gap > 0.3 * TOLERANCES.target_gap, "a gap of {gap} m");
}

#[test]
fn reports_book_the_energy_that_impacts_take() {
    let mut parts = discs_in_a_box(20, &mut Random(2));
    for part in &mut parts {
        part.body.elasticity = 0.9;
    }
    let mut system = system(parts);
    let before = energy(&system, 0.0);
    let mut booked = 0.0;
    let until = 5.0;
    advance_until(&mut system, Time::from_seconds(until), |system, handled| {
        assert!(handled.impact, "nothing comes to rest");
        let report = system.last_impact();
        assert!(report.energy_change <= 0.0);
        assert!(report.rows.iter().all(|row| row.impulse > 0.0 && row.rate_after >= 0.0));
        booked += report.energy_change;
    })
    .expect("impacts of few rows");
    let change = energy(&system, until) - before;
    assert!(booked < -0.1 * before, "only {booked} J were lost");
    assert!((change - booked).abs() < 1e-12 * before, "booked {booked} J, lost {change} J");
}
