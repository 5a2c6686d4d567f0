//! How far an active row is from running off its features, or its piece of a rail.

use crate::rigid::connectors::ends::rail_room;
use crate::rigid::contacts::rows::{ActiveRow, CHANGE_SHARE, Mechanism, RowSource, moving_of};
use halfgap_collision::{BodyId, Moving, contact_levers};
use halfgap_geometry::{Feature, FeatureId, GapSample};

impl Mechanism<'_> {
    /// Distance [m] from an active row to the end of its features or its piece of a rail; negative once it has run off.
    /// `None` for rows that cannot.
    pub(crate) fn way_to_end(&self, row: &ActiveRow, movings: &[Moving]) -> Option<f64> {
        if !self.can_change(row) {
            return None;
        }
        let [a, b] = row.bodies.map(|body| moving_of(movings, body));
        match row.source {
            RowSource::Connector(id, _) => {
                let (anchor, path) = self.connectors[id.index()].on_rail()?;
                rail_room(path, a.pose.point_to_world(anchor.point), row.hint.as_ref())
            }
            RowSource::Anchor(_) | RowSource::Pull(_) => None,
            RowSource::Contact(features) => {
                let sample = self.sample(row.bodies, features, [a, b]);
                let lean = if row.leans { 0.0 } else { self.lean(sample, row.bodies, features, [a, b]) };
                let outside = sample.overrun.max(lean);
                let inside = || self.inside(&sample, row, features, [a, b]);
                Some(self.change_margin() + if outside > 0.0 { -outside } else { inside() })
            }
        }
    }

    /// Distance [m] from a contact that lies within its features to their ends; on an arc, the angle to its end times a
    /// lever.
    fn inside(
        &self,
        sample: &GapSample,
        row: &ActiveRow,
        features: [FeatureId; 2],
        movings: [&Moving; 2],
    ) -> f64 {
        let shapes = row.bodies.map(|body| self.shape(body));
        let levers = contact_levers([0, 1].map(|side| (shapes[side], features[side])));
        let to_ends = |side: usize| {
            let (is_primary, pose) = ((side == 0) == sample.primary_is_a, &movings[side].pose);
            match shapes[side].feature(features[side]) {
                Feature::Line(line) => {
                    let along = pose.point_to_body(sample.point_normal).dot(line.normal.perp());
                    (along - line.start).min(line.end - along)
                }
                Feature::Round(_) if row.leans => f64::INFINITY,
                Feature::Round(round) => {
                    let sign = if is_primary { -round.sign() } else { round.sign() };
                    levers[side] * round.range.margin(pose.vector_to_body(sample.normal * sign))
                }
            }
        };
        to_ends(0).min(to_ends(1)).max(0.0)
    }

    /// Distance [m] by which a contact lies beyond the ends of its lines and arcs. A gap is measured as if these had no
    /// ends, so that after half a turn it would be to the back of the other body. The lean of a sharp corner does not
    /// count.
    pub(crate) fn overrun(
        &self,
        bodies: [BodyId; 2],
        features: [FeatureId; 2],
        movings: [&Moving; 2],
    ) -> f64 {
        let mut sample = self.sample(bodies, features, movings);
        let feature = |side: usize| self.shape(bodies[side]).feature(features[side]);
        sample.find_excess([0, 1].map(|side| (feature(side), &movings[side].pose)));
        let sides = if sample.primary_is_a { [0, 1] } else { [1, 0] };
        let of_arc = |(side, excess): (usize, f64)| match feature(side) {
            Feature::Round(round) => excess * round.radius.abs(),
            Feature::Line(_) => 0.0,
        };
        let arcs = sides.into_iter().zip([sample.excess_primary, sample.excess_normal]);
        arcs.map(of_arc).fold(sample.overrun, f64::max)
    }

    /// True if a row is a corner that leans off its line already: leaning further is no change.
    pub(crate) fn leans(&self, row: &ActiveRow, movings: [&Moving; 2]) -> bool {
        let RowSource::Contact(features) = row.source else { return false };
        let sample = self.sample(row.bodies, features, movings);
        if !self.is_corner_on_line(&sample, row.bodies, features, movings) {
            return false;
        }
        // Less than the share at which the change is an event, so that it is one only once.
        self.lean(sample, row.bodies, features, movings) > 0.5 * CHANGE_SHARE * self.tolerances.accuracy
    }

    /// True if a contact outside of its features has left them: a corner that leans off its line has not.
    pub(crate) fn has_left(
        &self,
        bodies: [BodyId; 2],
        features: [FeatureId; 2],
        movings: [&Moving; 2],
    ) -> bool {
        let sample = self.sample(bodies, features, movings);
        sample.overrun > 0.0 || !self.is_corner_on_line(&sample, bodies, features, movings)
    }

    /// True for a corner on a line, sharp or round, beyond which its body goes on straight. If the body leans a little,
    /// so that its next corner is nearer to the line, the first one still touches: so a block rocks from one corner to
    /// the other.
    fn is_corner_on_line(
        &self,
        sample: &GapSample,
        bodies: [BodyId; 2],
        features: [FeatureId; 2],
        movings: [&Moving; 2],
    ) -> bool {
        let feature = |side: usize| self.shape(bodies[side]).feature(features[side]);
        let round = match (feature(0), feature(1)) {
            (Feature::Round(_), Feature::Line(_)) => 0,
            (Feature::Line(_), Feature::Round(_)) => 1,
            _ => return false,
        };
        let is_sharp = feature(round).radius() == Some(0.0);
        is_sharp || {
            let direction = movings[round].pose.vector_to_body(-sample.normal);
            self.shape(bodies[round]).goes_on_straight(features[round], direction)
        }
    }

    /// Distance [m] by which a contact lies outside of its features: the angle beyond their ends times a lever.
    fn lean(
        &self,
        mut sample: GapSample,
        bodies: [BodyId; 2],
        features: [FeatureId; 2],
        movings: [&Moving; 2],
    ) -> f64 {
        let shape = |side: usize| self.shape(bodies[side]);
        let feature = |side: usize| (shape(side).feature(features[side]), &movings[side].pose);
        sample.find_excess([feature(0), feature(1)]);
        let levers = contact_levers([0, 1].map(|side| (shape(side), features[side])));
        let [primary, normal] = if sample.primary_is_a { levers } else { [levers[1], levers[0]] };
        (sample.excess_primary * primary).max(sample.excess_normal * normal)
    }
}
