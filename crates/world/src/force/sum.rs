//! Sums over several laws.

use super::{ForceLaw, Snapshot, Wrench, Wrenches};
use std::sync::Arc;

/// Returns the sum of the potentials of the laws that have one [J].
pub(crate) fn potential_of<'a>(
    force_laws: impl Iterator<Item = &'a Arc<dyn ForceLaw>>,
    now: &Snapshot<'_>,
) -> f64 {
    force_laws.filter_map(|law| law.potential(now)).sum()
}

/// Returns the sums of forces and torques on each of `bodies` bodies.
pub(crate) fn wrenches_of(
    force_laws: &[Arc<dyn ForceLaw>],
    now: &Snapshot<'_>,
    bodies: usize,
) -> Vec<Wrench> {
    let mut sums = vec![Wrench::default(); bodies];
    for law in force_laws {
        law.apply(now, &mut Wrenches::new(&mut sums));
    }
    sums
}
