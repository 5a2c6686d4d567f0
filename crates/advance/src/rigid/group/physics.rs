//! The parts of a system from which the motion of groups is computed.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::force_law::{ForceLaw, Snapshot};
use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::rows::Mechanism;
use crate::rigid::remedies::Remedies;
use crate::rigid::settings::{ExtraAcceleration, RigidSettings, StepControl};
use crate::rigid::surfaces::Surfaces;
use halfgap_collision::{Connector, Moving};
use std::sync::Arc;

/// Parts of a system from which the motion of its groups is computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Physics<'a> {
    pub(crate) mechanism: Mechanism<'a>,
    pub(crate) force_laws: &'a [Arc<dyn ForceLaw>],
    pub(crate) extra: Option<ExtraAcceleration>,
    pub(crate) steps: &'a StepControl,
    pub(crate) remedies: &'a Remedies,
    /// States may be moved onto the active rows.
    pub(crate) projects: bool,
}

impl<'a> Physics<'a> {
    /// The physics of a system with these parts.
    pub(crate) fn of(
        (trajectories, surfaces): (&'a [Trajectory], &'a Surfaces),
        connectors: &'a [Connector],
        force_laws: &'a [Arc<dyn ForceLaw>],
        (settings, remedies): (&'a RigidSettings, &'a Remedies),
    ) -> Self {
        let tolerances = &settings.tolerances;
        let mechanism = Mechanism { trajectories, surfaces, connectors, tolerances, time: 0.0 };
        let RigidSettings { extra, ref steps, projection: projects, .. } = *settings;
        Self { mechanism, force_laws, extra, steps, remedies, projects }
    }

    /// What the laws see of bodies that move like this at a time [s].
    pub(crate) fn snapshot(&self, time: f64, movings: &'a [Moving]) -> Snapshot<'a> {
        Snapshot::of_unwound(time, movings, self.mechanism.trajectories)
    }
}

/// The parts of the system from which the motion of groups is computed. Rows are measured at the time that whoever places
/// the bodies sets.
pub(crate) fn physics<'a>(assembly: &'a Assembly, connectors: &'a Connectors) -> Physics<'a> {
    Physics::of(
        (assembly.trajectories(), assembly.surfaces()),
        connectors.all(),
        &assembly.force_laws().all,
        (assembly.settings(), assembly.remedies()),
    )
}
