//! What others may read of a group.

use crate::ode::SegmentPolynomial;
use crate::rigid::connectors::store::{Connectors, Stop};
use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::{ActiveRow, RowSource};
use crate::rigid::group::physics::Physics;
use crate::rigid::group::state::{Group, SegmentEnd, Work};
use crate::rigid::group::stiffness::Stiffness;
use crate::time::Time;
use halfgap_collision::{BodyId, ConnectorId};

impl Group {
    /// Its bodies, ascending.
    #[inline]
    pub(crate) fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    /// Force [N] of each row at the end of the segment.
    #[inline]
    pub(crate) fn end_forces(&self) -> &[f64] {
        &self.end_forces
    }

    /// State at the end of the segment.
    #[inline]
    pub(crate) fn end_state(&self) -> &[f64] {
        &self.end_state
    }

    /// The event that ends the segment early, if there is one, and its offset [s].
    #[inline]
    pub(crate) fn event(&self) -> Option<(f64, SegmentEnd)> {
        self.event
    }

    /// Force [N] of each row at the start of the segment.
    #[inline]
    pub(crate) fn forces(&self) -> &[f64] {
        &self.forces
    }

    /// Contacts within the group that touch without force, each with the gap [m] below which it fires.
    #[inline]
    pub(crate) fn idle(&self) -> &[ActiveRow] {
        &self.idle
    }

    /// Another group was ended at the time at which this one was made, because a contact pulled from the start; here it
    /// may pull again.
    #[inline]
    pub(crate) fn is_patient(&self) -> bool {
        self.is_patient
    }

    /// No event can end its segments early: dense output may be postponed until it is asked for.
    #[inline]
    pub(crate) fn is_unwatched(&self) -> bool {
        self.is_unwatched
    }

    /// Largest error [m] of a connector, in the middle of the segment, or at its end if the middle was not evaluated.
    #[inline]
    pub(crate) fn largest_error(&self) -> f64 {
        self.largest_error
    }

    /// Force laws that act on its bodies, ascending.
    #[inline]
    pub(crate) fn force_laws(&self) -> &[usize] {
        &self.force_laws
    }

    /// The least gap [m] of an active contact within the segment, if there is one and its gap was evaluated there.
    #[inline]
    pub(crate) fn least_gap(&self) -> Option<f64> {
        self.least_gap
    }

    /// Offset [s] up to which the stages of the step show that no contact loses its force, while the search for events
    /// has not gone further.
    #[inline]
    pub(crate) fn look(&self) -> Option<f64> {
        self.look
    }

    /// Time at which the group was made.
    #[inline]
    pub(crate) fn made(&self) -> Time {
        self.made
    }

    /// Length of the next step to try [s]; `None` if nothing is known.
    #[inline]
    pub(crate) fn next_step(&self) -> Option<f64> {
        self.next_step
    }

    /// x, y and angle of each body along the segment.
    #[inline]
    pub(crate) fn paths(&self) -> &[[SegmentPolynomial; 3]] {
        &self.paths
    }

    /// Energy [J] that the projection of the end has added.
    #[inline]
    pub(crate) fn projected(&self) -> f64 {
        self.projected
    }

    /// Rates of `state` at the start of the segment.
    #[inline]
    pub(crate) fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// The active rows: independent ones of the contacts, and every row of the connectors.
    #[inline]
    pub(crate) fn rows(&self) -> &[ActiveRow] {
        &self.rows
    }

    /// True if friction acts at any of its rows.
    pub(crate) fn is_rough(&self) -> bool {
        self.rows.iter().any(ActiveRow::is_rough)
    }

    /// True if a contact of it slips.
    pub(crate) fn slips(&self) -> bool {
        self.rows.iter().any(ActiveRow::slips)
    }

    /// True if forces of its rows are not unique, and shared as the event found them.
    pub(crate) fn shares_forces(&self) -> bool {
        !(self.spares.is_empty() && self.prescribed.is_empty())
            || self.pulls.iter().any(|pull| pull.left.is_none())
    }

    /// Number of spare anchors, which come first among the spare rows.
    pub(crate) fn spare_anchors(&self) -> usize {
        self.spares.iter().take_while(|row| row.anchor_bound().is_some()).count()
    }

    /// Rows that follow from others, each with its forces.
    #[inline]
    pub(crate) fn spares(&self) -> &[ActiveRow] {
        &self.spares
    }

    /// Places in `bodies` of the two bodies of each row; `None` for one that cannot move.
    #[inline]
    pub(crate) fn sides(&self) -> &[[Option<u32>; 2]] {
        &self.sides
    }

    /// Length of the segment [s].
    #[inline]
    pub(crate) fn span(&self) -> f64 {
        self.span
    }

    /// Time at which its segment starts.
    #[inline]
    pub(crate) fn start(&self) -> Time {
        self.start
    }

    /// Position (x, y, angle) of each body, then velocities likewise, then works.
    #[inline]
    pub(crate) fn state(&self) -> &[f64] {
        &self.state
    }

    /// The stiffness.
    #[inline]
    pub(crate) fn stiffness(&self) -> Stiffness {
        self.stiffness
    }

    /// The first time [s] later than another at which a force law, a drive or a moved body of the group is not smooth.
    pub(crate) fn next_kink(&self, physics: &Physics<'_>, after: f64) -> Option<f64> {
        let of_laws = self.force_laws.iter().filter_map(|&law| physics.force_laws[law].next_kink(after));
        let of_drives = self.rows.iter().filter_map(|row| match row.source {
            RowSource::Connector(id, _) => physics.mechanism.connectors[id.index()].next_kink(after),
            RowSource::Contact(_) | RowSource::Anchor(_) | RowSource::Pull(_) => None,
        });
        let trajectories = physics.mechanism.trajectories;
        let of_moved = self.moved.iter().filter_map(|body| trajectories[body.index()].next_kink(after));
        of_laws.chain(of_drives).chain(of_moved).reduce(f64::min)
    }

    /// True if friction or damping takes energy from it.
    pub(crate) fn loses_energy(&self) -> bool {
        self.works.iter().any(|work| matches!(work, Work::Damping | Work::Friction(_) | Work::Rubbing))
    }

    /// True if it has no freedom left, as where a drive moves a linkage: it has no rates of its own then, and what is told of them is
    /// rounding.
    pub(crate) fn is_determined(&self) -> bool {
        self.rows.len() >= 3 * self.bodies.len() + self.dependent
    }

    /// A drive among its rows.
    pub(crate) fn drive(&self, connectors: &Connectors) -> Option<ConnectorId> {
        self.rows.iter().find_map(|row| match row.source {
            RowSource::Connector(id, _) => connectors.connector(id).is_driven().then_some(id),
            RowSource::Contact(_) | RowSource::Anchor(_) | RowSource::Pull(_) => None,
        })
    }

    /// True if its last step came so near a bifurcation point that its rows hardly hold each for itself.
    pub(crate) fn is_near_singular(&self) -> bool {
        self.kept.is_near_singular()
    }

    /// The stops.
    #[inline]
    pub(crate) fn stops(&self) -> &[Stop] {
        &self.stops
    }

    /// Motors, and dry friction in joints, that act with all their force.
    #[inline]
    pub(crate) fn pulls(&self) -> &[Pull] {
        &self.pulls
    }

    /// The works.
    #[inline]
    pub(crate) fn works(&self) -> &[Work] {
        &self.works
    }
}
