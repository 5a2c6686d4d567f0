//! Bodies that a pin and a drive of its angle hold to what cannot move: their motion is known beforehand, and the forces of their rows
//! follow from it (`ActiveRows`).
//!
//! *Invariant*: on a held body no row acts beside these but those of contacts. Other joints could depend on them, and would share their
//! forces.

use crate::rigid::contacts::rows::RowSource;
use crate::rigid::group::state::Group;
use halfgap_collision::Connector;
use halfgap_contact::HeldBody;

impl Group {
    /// The held bodies; the sides of rows must be known.
    pub(super) fn held(&self, connectors: &[Connector]) -> impl Iterator<Item = HeldBody> {
        self.driven.iter().filter_map(|&drive| self.held_by(drive, connectors))
    }

    /// The body that a driven row holds together with a pin.
    fn held_by(&self, drive: usize, connectors: &[Connector]) -> Option<HeldBody> {
        let connector = |row: usize| match self.rows[row].source {
            RowSource::Connector(id, _) => Some(&connectors[id.index()]),
            RowSource::Contact(_) | RowSource::Anchor(_) | RowSource::Pull(_) => None,
        };
        let ([Some(body), None] | [None, Some(body)]) = self.sides[drive] else { return None };
        let is_angle = connector(drive)?.anchors() == [None; 2];
        let on_body = |row: &usize| self.sides[*row].contains(&Some(body));
        let is_joint = |row: &usize| on_body(row) && connector(*row).is_some();
        let mut pin = (0..self.rows.len()).filter(is_joint).filter(|&row| row != drive);
        let [x, y] = [pin.next()?, pin.next()?];
        let is_pin = connector(x)?.is_pin() && self.sides[x].contains(&None) && y == x + 1;
        let is_alone = pin.next().is_none() && self.thirds.iter().all(|third| third.body != body);
        let place = |row: usize| u32::try_from(row).ok();
        (is_angle && is_pin && is_alone)
            .then_some(HeldBody { body, rows: [place(x)?, place(y)?, place(drive)?] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::contacts::friction::Grip;
    use crate::rigid::contacts::rows::ActiveRow;
    use glam::DVec2;
    use halfgap_collision::{Anchor, BodyId, ConnectorId, ConnectorKind, Coordinate, MotionLaw};
    use halfgap_geometry::FeatureId;

    const CRANK: BodyId = BodyId(0);
    const WHEEL: BodyId = BodyId(1);

    fn row(source: RowSource, bodies: [BodyId; 2]) -> ActiveRow {
        ActiveRow {
            source,
            bodies,
            third: None,
            bilateral: !matches!(source, RowSource::Contact(_)),
            gap: 0.0,
            hint: None,
            leans: false,
            grips: [Grip::Smooth; 2],
            load: [0.0; 3],
        }
    }

    /// The held bodies of a group of a crank and a wheel that touch, held by these connectors.
    fn held(kinds: Vec<ConnectorKind>) -> Vec<HeldBody> {
        let connectors: Vec<_> =
            kinds.into_iter().map(|kind| Connector::new(kind, 0.0).expect("fine numbers")).collect();
        let joints = (0..).zip(&connectors).flat_map(|(id, connector)| {
            (0..connector.row_count())
                .map(move |index| row(RowSource::Connector(ConnectorId(id), index), connector.bodies()))
        });
        let contact = row(RowSource::Contact([FeatureId(0); 2]), [CRANK, WHEEL]);
        let mut group = Group::default();
        group
            .set_members([CRANK, WHEEL].into_iter(), joints.chain([contact]).collect::<Vec<_>>().into_iter());
        group.driven = (0..group.rows.len()).filter(|&row| group.rows[row].is_driven(&connectors)).collect();
        group.find_sides();
        group.held(&connectors).collect()
    }

    fn pin(a: BodyId, b: BodyId) -> ConnectorKind {
        let [a, b] = [a, b].map(|body| Anchor { body, point: DVec2::ZERO });
        ConnectorKind::Pin { a, b }
    }

    fn drive(a: BodyId, b: BodyId) -> ConnectorKind {
        ConnectorKind::Drive { coordinate: Coordinate::angle(a, b), law: MotionLaw::Uniform(1.0), at: 0.0 }
    }

    #[test]
    fn a_pin_and_a_drive_hold_a_body_that_touches_another() {
        let (to_world, driven) = (pin(BodyId::WORLD, CRANK), drive(BodyId::WORLD, CRANK));
        let wheel = pin(BodyId::WORLD, WHEEL);
        let crank = HeldBody { body: 0, rows: [2, 3, 4] };
        assert_eq!(held(vec![wheel.clone(), to_world.clone(), driven.clone()]), [crank]);
        // Either may come first, and the sides do not matter.
        let crank = HeldBody { body: 0, rows: [1, 2, 0] };
        assert_eq!(
            held(vec![drive(CRANK, BodyId::WORLD), pin(CRANK, BodyId::WORLD), wheel.clone()]),
            [crank]
        );
        assert_eq!(held(vec![to_world, wheel, driven, drive(BodyId::WORLD, WHEEL)]).len(), 2);
    }

    #[test]
    fn a_body_with_other_joints_or_on_one_that_moves_is_not_held() {
        let (to_world, driven) = (pin(BodyId::WORLD, CRANK), drive(BodyId::WORLD, CRANK));
        let wheel = pin(BodyId::WORLD, WHEEL);
        let driven_wheel = drive(CRANK, WHEEL);
        for kinds in [
            vec![to_world.clone(), driven.clone(), pin(CRANK, WHEEL)],
            vec![to_world.clone(), to_world.clone(), driven.clone()],
            vec![to_world.clone(), driven.clone(), driven.clone()],
            vec![pin(CRANK, WHEEL), driven.clone()],
            vec![to_world, driven, driven_wheel.clone()],
            vec![wheel, pin(CRANK, WHEEL), driven_wheel],
        ] {
            assert!(held(kinds.clone()).is_empty(), "{kinds:?}");
        }
    }
}
