//! Friction at active contacts: what a contact's row is told of it, and the row of one that sticks.
//!
//! In the plane a contact that sticks is holonomic: its slip is the rate of a coordinate, which a row of its own keeps as a
//! pin keeps its gap. A contact that slips has no such row: its friction is a share of its force along the normal.
//!
//! Rolling resistance is another such friction of the same contact, along another axis: in `rolling` it is written as a force, too.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::rows::{ActiveRow, Mechanism, RowMoment, RowSource, mechanism, source_of};
use crate::rigid::surface::{PairSurface, RowFriction};
use halfgap_collision::{self as collision, BodyId, Collision, GapKinematics, Moving, TangentRow, turned};
use halfgap_geometry::{FeatureId, GapSample};

/// Along what friction acts at a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Axis {
    /// The normal turned by +90 degrees, along which the bodies slip.
    Slip,
    /// Their relative rotation, by the radius at which they roll on each other.
    Turn,
}

impl Axis {
    pub(crate) const ALL: [Self; 2] = [Self::Slip, Self::Turn];
}

/// What friction does at an active row along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Grip {
    /// Nothing.
    #[default]
    Smooth,
    /// The contact slips to a side, 1 or -1: its force along the axis is the coefficient [-] times that along the normal, to
    /// the other side. Of a contact that sets out from rest the event has left the speed `left` [m/s], by rounding.
    Slips { side: f64, coefficient: f64, left: f64 },
    /// The contact sticks: the force along the axis is no more than the coefficient [-] times that along its normal. In a
    /// group a row of its own, the anchor, keeps it, or shares the anchor of another.
    Sticks { coefficient: f64, anchor: Option<u32> },
    /// The row is an anchor along an axis, of a contact that keeps this gap [m]. Beyond what the contacts of its group allow, its force may be as
    /// large as the bound [N].
    Anchor { axis: Axis, kept_gap: f64, bound: f64 },
    /// The row holds the coordinate of a motor, or of dry friction in a joint, with at most this force [N].
    Bounded { most: f64 },
}

impl Grip {
    /// The share [-] of the normal force that acts along the axis; `None` where the contact does not slip.
    #[inline]
    pub(crate) fn slip_share(self) -> Option<f64> {
        match self {
            Self::Slips { side, coefficient, .. } => Some(-side * coefficient),
            _ => None,
        }
    }
}

impl ActiveRow {
    /// What friction does at it along an axis.
    #[inline]
    pub(crate) fn grip(&self, axis: Axis) -> Grip {
        self.grips[axis as usize]
    }

    /// True if friction acts at it.
    #[inline]
    pub(crate) fn is_rough(&self) -> bool {
        self.grips != [Grip::Smooth; 2]
    }

    /// True if it slips along any axis.
    #[inline]
    pub(crate) fn slips(&self) -> bool {
        self.grips.iter().any(|grip| grip.slip_share().is_some())
    }

    /// What an anchor bears beyond what its contacts allow, and what a motor bears [N]; `None` for other rows.
    #[inline]
    pub(crate) fn anchor_bound(&self) -> Option<f64> {
        match self.grips[0] {
            Grip::Anchor { bound, .. } => Some(bound),
            Grip::Bounded { most } => Some(most),
            _ => None,
        }
    }

    /// True for a motor, or dry friction in a joint, that holds.
    #[inline]
    pub(crate) fn is_pull(&self) -> bool {
        matches!(self.grips[0], Grip::Bounded { .. })
    }

    /// The anchors by which a contact is kept, each with the coefficient [-] up to which it is.
    #[inline]
    pub(crate) fn kept_by(&self) -> impl Iterator<Item = (usize, f64)> + use<> {
        self.grips.into_iter().filter_map(|grip| match grip {
            Grip::Sticks { coefficient, anchor: Some(anchor) } => Some((anchor as usize, coefficient)),
            _ => None,
        })
    }

    /// Lets a contact that sticks along an axis be kept by the anchor at a place in its group.
    pub(crate) fn keep_by(&mut self, axis: Axis, place: u32) {
        if let Grip::Sticks { anchor, .. } = &mut self.grips[axis as usize] {
            *anchor = Some(place);
        }
    }

    /// Adds a contact's force [N] along an axis to its anchor.
    pub(crate) fn add_load(&mut self, force: f64) {
        self.load[0] += force;
    }

    /// Raises the bound of an anchor [N].
    pub(crate) fn raise_bound(&mut self, force: f64) {
        if let Grip::Anchor { bound, .. } = &mut self.grips[0] {
            *bound += force;
        }
    }

    /// Friction at a contact as the event found it; `None` where there is none.
    pub(crate) fn told_friction(&self) -> Option<RowFriction> {
        let [normal, along, _] = self.load;
        match self.grip(Axis::Slip) {
            Grip::Slips { side, coefficient, .. } => {
                let most = coefficient * normal;
                Some(RowFriction { force: -side * most, slip_speed: 0.0, most, sticks: false })
            }
            Grip::Sticks { coefficient, .. } => {
                Some(RowFriction { force: along, slip_speed: 0.0, most: coefficient * normal, sticks: true })
            }
            Grip::Smooth | Grip::Anchor { .. } | Grip::Bounded { .. } => None,
        }
    }
}

impl Mechanism<'_> {
    /// Gap and slip of a contact, which keeps a gap [m].
    pub(crate) fn measure_slip(
        &self,
        contact: ([BodyId; 2], [FeatureId; 2]),
        movings: [&Moving; 2],
        kept_gap: f64,
    ) -> (RowMoment, TangentRow) {
        let sample = self.sample(contact.0, contact.1, movings);
        self.slip_at(contact.0, &self.touch_of(contact, &sample, movings, kept_gap))
    }

    /// Gap and slip of two bodies that touch like this.
    fn slip_at(&self, bodies: [BodyId; 2], touch: &collision::Touch<'_>) -> (RowMoment, TangentRow) {
        let kinematics = GapKinematics::of(touch.sample, touch.bodies[0], touch.bodies[1]);
        let slip = TangentRow::of(touch, &kinematics, bodies.map(|body| self.surfaces.speed(body)));
        (RowMoment { gap: touch.sample.gap, kinematics }, slip)
    }

    /// Speed [m/s] of a contact's row along an axis; 0 of others.
    pub(crate) fn slip_speed(&self, row: &ActiveRow, axis: Axis, movings: [&Moving; 2]) -> f64 {
        let RowSource::Contact(features) = row.source else { return 0.0 };
        match axis {
            Axis::Slip => self.measure_slip((row.bodies, features), movings, row.gap).1.rate,
            Axis::Turn => self.turning((row.bodies, features), movings).rate,
        }
    }

    /// The anchor of a contact: its coordinate [m], with the slip as its rate. `near` [m] is a value of the coordinate near the
    /// present one; it tells turns of the normal apart.
    pub(crate) fn measure_anchor(
        &self,
        contact: ([BodyId; 2], [FeatureId; 2]),
        movings: [&Moving; 2],
        kept_gap: f64,
        near: f64,
    ) -> RowMoment {
        let (bodies, features) = contact;
        let sample = self.sample(bodies, features, movings);
        let touch = self.touch_of(contact, &sample, movings, kept_gap);
        let (moment, TangentRow { rate, jacobian, gamma }) = self.slip_at(bodies, &touch);
        let kinematics = GapKinematics { rate, jacobian, gamma, ..moment.kinematics };
        // A surface that runs has no place to return to.
        if bodies.iter().any(|&body| self.surfaces.speed(body) != 0.0) {
            return RowMoment { gap: near, kinematics };
        }
        let [ra, rb] = touch.inflated();
        let turns = (near + ra * movings[0].angle + rb * movings[1].angle) / (ra + rb);
        RowMoment { gap: touch.coordinate(turned(sample.normal, turns)), kinematics }
    }

    fn touch_of<'a>(
        &self,
        (bodies, features): ([BodyId; 2], [FeatureId; 2]),
        sample: &'a GapSample,
        movings: [&'a Moving; 2],
        kept_gap: f64,
    ) -> collision::Touch<'a> {
        let radii = [0, 1].map(|side: usize| self.feature(bodies[side], features[side]).radius());
        collision::Touch { sample, radii, bodies: movings, kept_gap }
    }

    /// The anchor along an axis of a contact that sticks, as a row beside the contact's own.
    pub(crate) fn anchor_of(&self, row: &ActiveRow, axis: Axis, movings: [&Moving; 2]) -> Option<ActiveRow> {
        let (RowSource::Contact(features), Grip::Sticks { .. }) = (row.source, row.grip(axis)) else {
            return None;
        };
        let contact = (row.bodies, features);
        let gap = match axis {
            Axis::Slip => self.measure_anchor(contact, movings, row.gap, 0.0).gap,
            Axis::Turn => self.measure_turn(contact, movings).gap,
        };
        let grips = [Grip::Anchor { axis, kept_gap: row.gap, bound: 0.0 }, Grip::Smooth];
        Some(ActiveRow {
            source: RowSource::Anchor(features),
            bilateral: true,
            gap,
            grips,
            load: [0.0; 3],
            ..*row
        })
    }

    /// Gap and kinematics of an anchor's row.
    pub(crate) fn measure_anchor_row(
        &self,
        row: &ActiveRow,
        features: [FeatureId; 2],
        movings: [&Moving; 2],
    ) -> RowMoment {
        let contact = (row.bodies, features);
        match row.grips[0] {
            Grip::Anchor { axis: Axis::Turn, .. } => self.measure_turn(contact, movings),
            Grip::Anchor { kept_gap, .. } => self.measure_anchor(contact, movings, kept_gap, row.gap),
            _ => self.measure_anchor(contact, movings, row.gap, row.gap),
        }
    }
}

/// The slip of a contact's record, as the bodies move now; `None` for other rows, and where surfaces have no friction.
pub(crate) fn slip_of(
    assembly: &Assembly,
    connectors: &Connectors,
    record: &Collision,
) -> Option<(TangentRow, PairSurface)> {
    let Some(RowSource::Contact(features)) = source_of(record) else { return None };
    let (bodies, mechanism) = (record.bodies(), mechanism(assembly, connectors));
    let surface = mechanism.surfaces.together(bodies);
    if !surface.has_friction() {
        return None;
    }
    let movings = bodies.map(|body| assembly.moving_at(body, assembly.now()));
    let kept_gap = record.geometry.distance;
    let (_, row) = mechanism.measure_slip((bodies, features), [&movings[0], &movings[1]], kept_gap);
    Some((row, surface))
}
