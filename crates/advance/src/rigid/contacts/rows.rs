//! The rows that hold bodies together or apart during a segment: contacts and connectors, measured at any moment.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::friction::Grip;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::surfaces::Surfaces;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{
    BodyId, Collision, Connector, ConnectorId, ConnectorSample, Detector, GapKinematics, Moving, RailHint,
    Surroundings, Tolerances,
};
use halfgap_contact::{CollisionRow, CollisionThird};
use halfgap_geometry::{DirectionRange, Feature, FeatureId, GapSample, Shape};

/// Fraction of `accuracy` by which a contact may run off its features before it counts as changed: more than the
/// rounding by which a contact that has run off is still detected, far less than forces are sensitive to.
pub(crate) const CHANGE_SHARE: f64 = 1.0 / 64.0;

/// Origin of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum RowSource {
    /// A feature of the primary and one of the normal body.
    Contact([FeatureId; 2]),
    /// The slip, or the rolling, of a contact that sticks, of a feature of the primary and one of the normal body.
    Anchor([FeatureId; 2]),
    /// A row of a connector, by its index there.
    Connector(ConnectorId, usize),
    /// The coordinate of a motor or of dry friction in a joint that holds it.
    Pull(ConnectorId),
}

/// An active row: its gap is kept as it is.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ActiveRow {
    pub(crate) source: RowSource,
    /// The primary and the normal body.
    pub(crate) bodies: [BodyId; 2],
    /// A third body on which it acts by its rotation, with its coefficient [m].
    pub(crate) third: Option<(BodyId, f64)>,
    pub(crate) bilateral: bool,
    /// Gap [m] at which it is held: the one at which it formed, but for rows that are lifted.
    pub(crate) gap: f64,
    /// Piece of the rail, if the connector has one.
    pub(crate) hint: Option<RailHint>,
    /// It is a corner, sharp or round, that leans off its line.
    pub(crate) leans: bool,
    /// What friction does at it, by [`Axis`]; of an anchor the first.
    pub(crate) grips: [Grip; 2],
    /// Forces [N] that the event found along the normal, of an anchor along its axis; and of a contact along its axes.
    pub(crate) load: [f64; 3],
}

/// A row at one moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowMoment {
    /// Gap [m].
    pub(crate) gap: f64,
    pub(crate) kinematics: GapKinematics,
}

/// Bodies, connectors and tolerances by which rows are measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mechanism<'a> {
    pub(crate) trajectories: &'a [Trajectory],
    /// The surfaces of all bodies.
    pub(crate) surfaces: &'a Surfaces,
    pub(crate) connectors: &'a [Connector],
    pub(crate) tolerances: &'a Tolerances,
    /// Time [s] of the motions that rows are measured in.
    pub(crate) time: f64,
}

/// The motion of a body, or of the background.
#[inline]
pub(crate) fn moving_of(movings: &[Moving], body: BodyId) -> &Moving {
    if body.is_world() { &Moving::BACKGROUND } else { &movings[body.index()] }
}

impl Mechanism<'_> {
    pub(crate) fn shape(&self, body: BodyId) -> &Shape {
        &self.trajectories[body.index()].body().shape
    }

    /// Distance [m] from a body's centre of mass to its farthest point.
    pub(crate) fn trajectory_reach(&self, body: BodyId) -> f64 {
        self.trajectories[body.index()].reach()
    }

    /// A feature of a body.
    #[inline]
    pub(crate) fn feature(&self, body: BodyId, feature: FeatureId) -> &Feature {
        self.shape(body).feature(feature)
    }

    /// Gap and kinematics of a row.
    #[inline]
    pub(crate) fn measure(&self, row: &ActiveRow, movings: &[Moving]) -> RowMoment {
        let sides = row.bodies.map(|body| moving_of(movings, body));
        if let RowSource::Connector(id, index) = row.source {
            let carrier = self.connectors[id.index()].third().map(|(body, _)| moving_of(movings, body));
            let sample = self.measure_connector((id, index), sides, carrier, row.hint.as_ref());
            return RowMoment { gap: sample.gap, kinematics: sample.kinematics };
        }
        self.measure_between(row, sides)
    }

    /// The same with the two bodies moving like this. Of a third body, on which coefficients do not depend, nothing is known.
    #[inline]
    pub(crate) fn measure_between(&self, row: &ActiveRow, [a, b]: [&Moving; 2]) -> RowMoment {
        match row.source {
            RowSource::Connector(id, index) => {
                let sample = self.measure_connector((id, index), [a, b], None, row.hint.as_ref());
                RowMoment { gap: sample.gap, kinematics: sample.kinematics }
            }
            RowSource::Pull(id) => self.measure_held(row, id, [a, b]),
            RowSource::Contact(features) => self.measure_contact(row.bodies, features, [a, b]),
            RowSource::Anchor(features) => self.measure_anchor_row(row, features, [a, b]),
        }
    }

    /// A row of a connector, given the motions of its bodies and of the carrier, if it has one.
    #[inline]
    pub(crate) fn measure_connector(
        &self,
        (id, index): (ConnectorId, usize),
        movings: [&Moving; 2],
        carrier: Option<&Moving>,
        hint: Option<&RailHint>,
    ) -> ConnectorSample {
        let connector = &self.connectors[id.index()];
        let mut surroundings = Surroundings { time: self.time, hint, ..Surroundings::default() };
        if connector.counts_turns() {
            let turns = |body: BodyId| self.trajectories.get(body.index()).map_or(0.0, Trajectory::turns);
            let [a, b] = connector.bodies();
            let third = connector.third().map_or(0.0, |(body, _)| turns(body));
            surroundings.turns = [turns(a), turns(b), third];
            surroundings.carrier = carrier.unwrap_or(surroundings.carrier);
        }
        connector.measure_in(index, movings, &surroundings)
    }

    /// The part [m/s] of a row's rate that is prescribed: the bodies that can move have no share in it.
    pub(crate) fn prescribed_rate(&self, row: &ActiveRow) -> f64 {
        match row.source {
            RowSource::Connector(id, _) | RowSource::Pull(id) => {
                self.connectors[id.index()].prescribed_rate(self.time)
            }
            RowSource::Contact(_) | RowSource::Anchor(_) => 0.0,
        }
    }

    /// Gap [m] of a row; depends only on the poses of the bodies.
    pub(crate) fn gap(&self, row: &ActiveRow, movings: &[Moving]) -> f64 {
        let RowSource::Contact(features) = row.source else { return self.measure(row, movings).gap };
        self.sample_here(row.bodies, features, row.bodies.map(|body| moving_of(movings, body))).gap
    }

    /// Gap and kinematics of a contact. Inlined with everything it calls, so that unused results are not computed and
    /// the others stay in registers.
    #[inline(always)]
    pub(crate) fn measure_contact(
        &self,
        bodies: [BodyId; 2],
        features: [FeatureId; 2],
        movings: [&Moving; 2],
    ) -> RowMoment {
        let sample = self.sample_here(bodies, features, movings);
        RowMoment { gap: sample.gap, kinematics: GapKinematics::of(&sample, movings[0], movings[1]) }
    }

    /// Gap and kinematics of a row, for rows in their order: the second row of a pin is measured with the first and
    /// kept in `twin`.
    #[inline]
    pub(crate) fn measure_next(
        &self,
        row: &ActiveRow,
        movings: &[Moving],
        twin: &mut Option<(ConnectorId, RowMoment)>,
    ) -> RowMoment {
        let RowSource::Connector(id, index) = row.source else { return self.measure(row, movings) };
        if let (1, Some((of, moment))) = (index, *twin)
            && of == id
        {
            return moment;
        }
        let [a, b] = row.bodies.map(|body| moving_of(movings, body));
        match self.connectors[id.index()].measure_pin(a, b) {
            Some(samples) => {
                let [first, second] =
                    samples.map(|sample| RowMoment { gap: sample.gap, kinematics: sample.kinematics });
                *twin = Some((id, second));
                if index == 0 { first } else { second }
            }
            None => self.measure(row, movings),
        }
    }

    /// The gap of two features of a row, even beyond their ends.
    pub(crate) fn sample(
        &self,
        bodies: [BodyId; 2],
        features: [FeatureId; 2],
        movings: [&Moving; 2],
    ) -> GapSample {
        self.sample_here(bodies, features, movings)
    }

    #[inline(always)]
    fn sample_here(&self, bodies: [BodyId; 2], features: [FeatureId; 2], movings: [&Moving; 2]) -> GapSample {
        let [a, b] = [0, 1].map(|side: usize| self.shape(bodies[side]).feature(features[side]));
        GapSample::measure_unbounded(a, &movings[0].pose, b, &movings[1].pose)
            .expect("a contact was made from features that touch")
    }

    /// True if a row may run off its features or its piece of a rail.
    pub(crate) fn can_change(&self, row: &ActiveRow) -> bool {
        match row.source {
            RowSource::Contact(features) => {
                // Full circles have no ends.
                let mut sides = row.bodies.iter().zip(features);
                !sides.all(|(&body, feature)| is_full(self.shape(body).feature(feature)))
            }
            RowSource::Anchor(_) | RowSource::Pull(_) => false,
            RowSource::Connector(id, _) => {
                let path = self.connectors[id.index()].path();
                !self.is_in_corner(row) && path.is_some_and(|path| !path.knots().is_empty())
            }
        }
    }

    /// True for one side of a corner of a rail in which its point rests: such a row only pushes.
    pub(crate) fn is_in_corner(&self, row: &ActiveRow) -> bool {
        let RowSource::Connector(id, _) = row.source else { return false };
        !row.bilateral && self.connectors[id.index()].is_bilateral()
    }

    /// Point [m] in the world at which a row's force acts on its primary body, the normal, and the coefficient [m] of the
    /// body's rotation.
    pub(crate) fn locate(&self, row: &ActiveRow, movings: &[Moving]) -> (DVec2, DVec2, f64) {
        let sides = row.bodies.map(|body| moving_of(movings, body));
        match row.source {
            RowSource::Connector(id, index) => {
                let sample = self.measure_connector((id, index), sides, None, row.hint.as_ref());
                (sample.point_a, sample.normal, sample.kinematics.jacobian[2])
            }
            RowSource::Pull(id) => self.locate_pull(id, sides),
            RowSource::Contact(features) | RowSource::Anchor(features) => {
                let sample = self.sample(row.bodies, features, sides);
                let arm = sample.point_primary - sides[0].pose.position;
                (sample.point_primary, sample.normal, arm.perp_dot(sample.normal))
            }
        }
    }

    /// Distance [m] by which a contact may run off its features before it counts as changed.
    pub(crate) fn change_margin(&self) -> f64 {
        CHANGE_SHARE * self.tolerances.accuracy
    }
}

fn is_full(feature: &Feature) -> bool {
    matches!(feature, Feature::Round(round) if round.range == DirectionRange::Full)
}

/// Source of the row of a record.
pub(crate) fn source_of(record: &Collision) -> Option<RowSource> {
    if let Detector::Connector { id, row } = record.parties.detector {
        return Some(RowSource::Connector(id, row as usize));
    }
    Some(RowSource::Contact([record.parties.primary.feature()?, record.parties.normal.feature()?]))
}

/// Row of a record in an impact.
pub(crate) fn row_of(assembly: &Assembly, record: &Collision) -> CollisionRow {
    let row = CollisionRow::of_collision(record, record.bodies().map(|body| assembly.inertia(body)));
    let third = |(body, j)| CollisionThird::new(body, j, assembly.inertia(body));
    CollisionRow { third: record.parties.third.map(third), ..row }
}

/// A row with `leans` set as it is at a time.
pub(crate) fn with_lean(
    assembly: &Assembly,
    connectors: &Connectors,
    row: ActiveRow,
    time: Time,
) -> ActiveRow {
    let movings = row.bodies.map(|body| assembly.moving_at(body, time));
    ActiveRow { leans: mechanism(assembly, connectors).leans(&row, [&movings[0], &movings[1]]), ..row }
}

/// Bodies, connectors and tolerances by which rows are measured.
pub(crate) fn mechanism<'a>(assembly: &'a Assembly, connectors: &'a Connectors) -> Mechanism<'a> {
    Mechanism {
        trajectories: assembly.trajectories(),
        surfaces: assembly.surfaces(),
        connectors: connectors.all(),
        tolerances: &assembly.settings().tolerances,
        time: assembly.now().seconds(),
    }
}

impl ActiveRow {
    /// Sets the gap [m] at which it is held, or fires.
    pub(crate) fn set_gap(&mut self, gap: f64) {
        self.gap = gap;
    }

    /// Sets the place near which its point on a rail is sought.
    pub(crate) fn set_hint(&mut self, hint: Option<RailHint>) {
        self.hint = hint;
    }

    /// The bodies that it acts on: its two, and the third, if there is one.
    pub(crate) fn all_bodies(&self) -> impl Iterator<Item = BodyId> + use<> {
        self.bodies.into_iter().chain(self.third.map(|(body, _)| body))
    }

    /// True for a row of a connector that always acts.
    #[inline]
    pub(crate) fn is_joint(&self) -> bool {
        self.bilateral && matches!(self.source, RowSource::Connector(..))
    }

    /// True for a row of a coordinate that is driven, or held at a speed.
    pub(crate) fn is_driven(&self, connectors: &[Connector]) -> bool {
        match self.source {
            RowSource::Connector(id, _) => connectors[id.index()].is_driven(),
            RowSource::Pull(id) => connectors[id.index()].prescribed_rate(0.0) != 0.0,
            RowSource::Contact(_) | RowSource::Anchor(_) => false,
        }
    }

    /// The features of a contact; `None` for a connector's row and an anchor's.
    pub(crate) fn touch(&self) -> Option<Touch> {
        match self.source {
            RowSource::Contact(features) => Some(Touch::new(self.bodies, features)),
            RowSource::Anchor(_) | RowSource::Connector(..) | RowSource::Pull(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::group::groups::group_of;
    use crate::rigid::test_scene::block_on_its_corner;
    use halfgap_geometry::Pose;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_corner_leans_by_what_it_is_long_itself_whichever_body_is_named_first() {
        // A round corner with a radius of 0.1 m on a floor of 20 m, which is body 0.
        let rooms = block_on_its_corner();
        let group = group_of(&rooms.assembly, &rooms.groups, BodyId(1)).expect("it is in a group");
        let row = ActiveRow { leans: false, ..group.rows()[0] };
        let RowSource::Contact([first, second]) = row.source else { panic!("it is a contact") };
        let source = RowSource::Contact([second, first]);
        let swapped = ActiveRow { bodies: [row.bodies[1], row.bodies[0]], source, ..row };
        let mechanism = mechanism(&rooms.assembly, &rooms.connectors);
        let room = |row: &ActiveRow, lean: f64| {
            let mut movings =
                [0, 1].map(|body| rooms.assembly.trajectory(BodyId(body)).moving_at(rooms.assembly.now()));
            let position = movings[1].pose.position;
            movings[1].pose = Pose::new(position, FRAC_PI_2 + lean / 0.1);
            mechanism.way_to_end(row, &movings).expect("the corner ends")
        };
        let margin = mechanism.change_margin();
        for part in [0.1, 0.5, 0.9, 1.1, 2.0] {
            let expected = (1.0 - part) * margin;
            for found in [&row, &swapped].map(|row| room(row, part * margin)) {
                // Features reach a little beyond smooth joints.
                assert!((found - expected).abs() < 0.02 * margin, "{part}: {found} m for {expected} m");
            }
        }
    }
}
