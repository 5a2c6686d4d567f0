//! Forces of contacts that stick, shared anew where one has come to its bound.

use crate::rigid::active_set::posing::pose_problem;
use crate::rigid::active_set::pulls::all_hold;
use crate::rigid::active_set::settling::Settling;
use crate::rigid::active_set::slips::all_stick;
use crate::rigid::group::stage::Stage;
use crate::rigid::region::touching::Region;
use crate::rigid::region::view::View;
use crate::rigid::shares::NARROWED;

/// Shares the forces of contacts that stick otherwise, each as far from its bound as can be: where rows are redundant many forces give the
/// same motion, and the next event comes the later.
pub(super) fn relax(view: &View<'_>, region: &Region, settling: &mut Settling, stage: &Stage) {
    let kept = settling.solution.clone();
    settling.slack = 1.0;
    // With less than that the next event comes no later.
    while settling.slack > NARROWED {
        settling.slack *= 0.5;
        pose_problem(view.assembly, view.connectors, region, settling, stage);
        if settling.solve_strictly().is_ok()
            && all_stick(settling)
            && all_hold(view.assembly, region, settling)
        {
            settling.slack = 0.0;
            return;
        }
    }
    settling.slack = 0.0;
    pose_problem(view.assembly, view.connectors, region, settling, stage);
    settling.solution = kept;
}
