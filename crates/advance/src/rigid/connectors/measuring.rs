//! The rows of connectors, measured at any time within the present segments.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::time::Time;
use halfgap_collision::{BodyId, Collision, ConnectorId, ConnectorSample, Moving, RailHint, Surroundings};

impl Connectors {
    /// Record of a row of a connector whose bodies move as given at a time. The sides of a corner are unilateral and
    /// without elasticity.
    pub(crate) fn connector_record(
        &self,
        assembly: &Assembly,
        id: ConnectorId,
        row: usize,
        moving: &[Moving; 2],
        time: Time,
    ) -> Collision {
        let (connector, state) = (self.connector(id), &self.states[id.index()]);
        let hint = self.hint_at(assembly, id, row, time);
        let sample = self.sample_at(assembly, (id, row), [&moving[0], &moving[1]], hint.as_ref(), time);
        let row = u32::try_from(row).unwrap_or(u32::MAX);
        let (bodies, tolerances) = ([&moving[0], &moving[1]], assembly.settings().tolerances);
        let mut record =
            Collision::of_connector(id, row, connector, &sample, bodies, &tolerances, time.seconds());
        if state.corner.is_some() {
            record.parties.bilateral = false;
            record.response.elasticity = 0.0;
        }
        record
    }

    /// Measures the record of a connector's row anew, and keeps its response.
    pub(crate) fn remeasure_connector(
        &self,
        assembly: &Assembly,
        record: &mut Collision,
        id: ConnectorId,
        row: u32,
        time: Time,
    ) {
        let moving = self.connector(id).bodies().map(|body| assembly.moving_at(body, time));
        let hint = self.hint_at(assembly, id, row as usize, time);
        let movings = [&moving[0], &moving[1]];
        let sample = self.sample_at(assembly, (id, row as usize), movings, hint.as_ref(), time);
        record.update_connector(self.connector(id), &sample, [&moving[0], &moving[1]], time.seconds());
        // The point of a rail may have come to a corner, or left one.
        let is_in_corner = self.states[id.index()].corner.is_some();
        record.parties.bilateral = self.connector(id).is_bilateral() && !is_in_corner;
    }

    /// Measures a row of a connector at a time.
    pub(crate) fn measure_connector(
        &self,
        assembly: &Assembly,
        id: ConnectorId,
        row: usize,
        time: Time,
    ) -> ConnectorSample {
        let [a, b] = self.connector(id).bodies().map(|body| assembly.moving_at(body, time));
        let hint = self.hint_at(assembly, id, row, time);
        self.sample_at(assembly, (id, row), [&a, &b], hint.as_ref(), time)
    }

    /// Measures a row of a connector whose bodies move as given at a time.
    pub(crate) fn sample_at(
        &self,
        assembly: &Assembly,
        (id, row): (ConnectorId, usize),
        movings: [&Moving; 2],
        hint: Option<&RailHint>,
        time: Time,
    ) -> ConnectorSample {
        let connector = self.connector(id);
        let carrier = connector.third().map(|(body, _)| assembly.moving_at(body, time));
        let turns = |body: BodyId| if body.is_world() { 0.0 } else { assembly.trajectory(body).turns() };
        let [a, b] = connector.bodies();
        let surroundings = Surroundings {
            time: time.seconds(),
            turns: [turns(a), turns(b), connector.third().map_or(0.0, |(body, _)| turns(body))],
            carrier: carrier.as_ref().unwrap_or(&Moving::BACKGROUND),
            hint,
        };
        connector.measure_in(row, movings, &surroundings)
    }
}
