//! Warnings of worlds that are built all the same.

use super::WorldBuilder;
use crate::force::ForceLaw;
use crate::rigid_settings::method;
use glam::DVec2;
use halfgap_advance::rigid::Scales;
use halfgap_collision::{BodyId, BodyState, Connector, ConnectorKind};
use halfgap_geometry::Rounded;
use std::sync::Arc;

impl WorldBuilder {
    /// Warning if the coordinates do not allow a target gap as small as the tolerance asks for.
    pub(super) fn gap_warning(&self, scales: &Scales) -> Option<String> {
        let tolerance = self.settings.tolerance;
        let (wanted, smallest) = (scales.wanted_gap(tolerance), scales.smallest_gap());
        let is_too_small = self.settings.overrides.target_gap.is_none() && wanted < smallest;
        is_too_small.then(|| {
            format!(
                "tolerance {} asks for a target gap of {} m, but coordinates, at the end of the run too, or radii of {} m allow no less than {} m",
                Rounded(tolerance),
                Rounded(wanted),
                Rounded(scales.coordinate),
                Rounded(smallest)
            )
        })
    }

    /// Warning if a given target gap is wider than a moving body.
    pub(super) fn wide_gap_warning(&self, scales: &Scales) -> Option<String> {
        let gap = self.settings.overrides.target_gap?;
        let radius = scales.smallest_radius.filter(|&radius| gap > radius)?;
        Some(format!(
            "a `target_gap` of {} m is larger than the smallest moving body, which reaches {} m from its centre of mass: \
             bodies meet at that distance, and those that are nearer at the start are moved apart",
            Rounded(gap),
            Rounded(radius)
        ))
    }

    /// Warning if there is nothing that can move.
    pub(super) fn still_warning(&self) -> Option<String> {
        if self.bodies.is_empty() {
            return Some("there are no bodies: nothing will happen".to_owned());
        }
        let all_fixed = self.bodies.iter().all(|body| body.inertia.is_none());
        let any_moved = self.bodies.iter().any(|body| body.motion.is_some());
        (all_fixed && !any_moved).then(|| "all bodies are fixed: nothing can move".to_owned())
    }

    /// Warning if all bodies on which a force law acts are fixed.
    pub(super) fn law_warning(&self) -> Option<String> {
        let is_fixed =
            |body: &BodyId| self.bodies.get(body.index()).is_none_or(|body| body.inertia.is_none());
        let acts_on_none =
            |law: &&Arc<dyn ForceLaw>| !law.bodies().is_empty() && law.bodies().iter().all(is_fixed);
        let law = self.forces.iter().find(acts_on_none)?;
        Some(format!("force \"{}\" acts on fixed bodies only: it moves nothing", law.name()))
    }

    /// Warning if a fixed step is too long for the damping of a body, whose motion then grows where it is integrated.
    /// Free flight is in closed form and not affected.
    pub(super) fn step_warning(&self) -> Option<String> {
        let settings = &self.settings;
        let step = settings.fixed_step().filter(|_| settings.integrator.has_fixed_step())?;
        let bodies = self.bodies.iter().zip(&self.free_motions);
        let rates = bodies.map(|(body, law)| (&body.name, law.linear_rate.max(law.angular_rate)));
        let (name, rate) = rates.max_by(|p, q| p.1.total_cmp(&q.1))?;
        let longest = method(settings.integrator).stability_limit()? / rate;
        (step > longest).then(|| {
            format!(
                "a `time_step` of {} s is too long for body \"{name}\", damped at {} 1/s: while it is tied or in contact, its \
                 motion grows instead of decaying in steps of more than {} s",
                Rounded(step),
                Rounded(rate),
                Rounded(longest)
            )
        })
    }

    /// Warning if a fixed body is given a velocity.
    pub(super) fn fixed_warning(&self) -> Option<String> {
        let moves = |state: &BodyState| state.velocity != DVec2::ZERO || state.angular_velocity != 0.0;
        let body = self.bodies.iter().find(|body| body.inertia.is_none() && moves(&body.state))?;
        Some(format!("body \"{}\" is fixed: its velocity is ignored", body.name))
    }

    /// Warning if a stop has no rail to end.
    pub(super) fn stop_warning(&self) -> Option<String> {
        let connectors = || self.connectors.iter().map(|spec| &spec.connector);
        let is_lone = |stop: &Connector| {
            let ends = matches!(stop.kind, ConnectorKind::RailStop { .. });
            ends && !connectors().any(|rail| stop.is_stop_of(rail))
        };
        let index = connectors().position(is_lone)?;
        let name = self.connector_name(index);
        Some(format!(
            "{name} ends no rail: no rail has the same point and path, so nothing keeps the point on the path"
        ))
    }
}
