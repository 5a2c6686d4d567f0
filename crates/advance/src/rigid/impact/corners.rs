//! Corners of rails: the point of a rail comes to one, may rest in it, and leaves it along one of its sides.
//!
//! Where a path turns, the point is on the piece before the corner or on the one after it. Let the normals n face into
//! the angle between the two, and u be the point's velocity: then n.u = 0 for its own piece and n.u >= 0 for the other
//! one. Two unilateral rows keep to this, except that they would let the point leave both pieces. So the point of a
//! rail has two unilateral rows from when it comes to a corner until one of them opens, or carries no force; the other
//! goes on as the bilateral row of its piece. Where both would open, the point is kept on one of the sides, whose force
//! or impulse then holds it back. A stop that lies in a corner is at the end of the piece along which the point comes:
//! a point that bounces off it does not turn.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::corners::go_along;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::rows::row_of;
use crate::rigid::region::touching::Region;
use crate::rigid::remedies::Remedy;
use halfgap_collision::{Collision, ConnectorId, Detector};

/// A corner of a rail that holds the rail's point, in a region.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub(crate) id: ConnectorId,
    /// Indices of the records of its sides, before and after.
    pub(crate) records: [usize; 2],
}

/// Puts a point that an impact drives off both sides of its corner on one of them, whose row then holds it back in
/// the same impact. True if there is such a point.
pub(crate) fn hold_back(
    assembly: &Assembly,
    connectors: &mut Connectors,
    region: &mut Region,
    rates: &[f64],
) -> bool {
    let (rest, fast) = (assembly.rest_speed(), assembly.settings().tolerances.velocity_tol);
    let opening = |corner: Corner| corner.records.map(|record| rates[record]);
    let is_driven_out = |corner: &Corner| {
        let [before, after] = opening(*corner);
        before.min(after) > rest && before.max(after) > fast
    };
    let Some(corner) = corners(region).find(is_driven_out) else { return false };
    if !assembly.remedies().act(Remedy::HeldInCorner) {
        return false;
    }
    let opening = opening(corner);
    take_slower(assembly, connectors, region, corner, opening);
    true
}

/// Takes the point of a rail out of its corner along the side from which it parts more slowly, relative to how
/// easily each row is moved; if both are equal, on along the path. Held there, its row opens the other one: with
/// free rates f and the matrix A of both rows, the other one opens at f_j - (A_ij/A_ii) f_i, which is positive for
/// the lesser f_i/sqrt(A_ii).
pub(crate) fn take_slower(
    assembly: &Assembly,
    connectors: &mut Connectors,
    region: &mut Region,
    corner: Corner,
    opening: [f64; 2],
) {
    let [before, after] = [0, 1].map(|side: usize| {
        let row = row_of(assembly, &region.records()[corner.records[side]]);
        let ease: f64 = row.jacobian.iter().zip(&row.response).map(|(j, response)| j * response).sum();
        opening[side] / ease.sqrt()
    });
    take_side(assembly, connectors, region, corner, usize::from(after <= before));
}

pub(crate) fn take_side(
    assembly: &Assembly,
    connectors: &mut Connectors,
    region: &mut Region,
    corner: Corner,
    side: usize,
) {
    go_along(connectors, corner.id, side);
    let moving =
        connectors.connector(corner.id).bodies().map(|body| assembly.moving_at(body, assembly.now()));
    let record = connectors.connector_record(assembly, corner.id, 0, &moving, assembly.now());
    region.set_record(corner.records[0], record);
    region.remove_record(corner.records[1]);
}

impl Corner {
    /// Rates [m/s] at which the point parts from the sides.
    pub(crate) fn rates(&self, region: &Region) -> [f64; 2] {
        self.records.map(|record| region.records()[record].motion.normal_velocity)
    }
}

/// Corners of rails in a region that hold a point: the records of the two sides follow each other.
pub(crate) fn corners(region: &Region) -> impl Iterator<Item = Corner> + use<'_> {
    let side = |record: &Collision| match record.parties.detector {
        Detector::Connector { id, row } if !record.parties.bilateral => Some((id, row)),
        _ => None,
    };
    region.records().windows(2).enumerate().filter_map(move |(first, pair)| {
        let [(id, 0), (other, 1)] = [side(&pair[0])?, side(&pair[1])?] else { return None };
        (id == other).then_some(Corner { id, records: [first, first + 1] })
    })
}
