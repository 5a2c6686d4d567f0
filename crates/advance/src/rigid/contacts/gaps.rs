//! Gap and rate of two features, also beyond their ends.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::rows::mechanism;
use crate::rigid::contacts::touch::Touch;
use crate::time::Time;
use halfgap_collision::{GapKinematics, GapState};
use halfgap_geometry::{Feature, GapSample};

/// True if a contact that has come to the end of its features has left them.
pub(crate) fn leaves(
    assembly: &Assembly,
    connectors: &Connectors,
    Touch { bodies, features }: Touch,
) -> bool {
    let moving = bodies.map(|body| assembly.trajectory(body).moving_at(assembly.now()));
    mechanism(assembly, connectors).has_left(bodies, features, [&moving[0], &moving[1]])
}

pub(crate) fn features_in(assembly: &Assembly, Touch { bodies, features }: Touch) -> [&Feature; 2] {
    [0, 1].map(|side: usize| assembly.trajectory(bodies[side]).body().shape.feature(features[side]))
}

/// Gap of two features at a time, also beyond their ends; without end where there is none. It is judged by the
/// tolerances of the scene, also in a tight fit: so contacts that sink do so by the same depth everywhere.
pub(crate) fn gap_at(assembly: &Assembly, touch: Touch, time: Time) -> GapState {
    let tolerances = &assembly.settings().tolerances;
    let moving = touch.bodies.map(|body| assembly.trajectory(body).moving_at(time));
    let [a, b] = features_in(assembly, touch);
    let Some(sample) = GapSample::measure_unbounded(a, &moving[0].pose, b, &moving[1].pose) else {
        return GapState::of_contact(f64::INFINITY, 0.0, tolerances);
    };
    let (primary, normal) = if sample.primary_is_a { (0, 1) } else { (1, 0) };
    let rate = GapKinematics::of(&sample, &moving[primary], &moving[normal]).rate;
    GapState::of_contact(sample.gap, rate, tolerances)
}
