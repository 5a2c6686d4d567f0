//! Connectors that contradict each other whatever the bodies do: two drives of one coordinate, and gears whose ratios along a loop do
//! not come back to 1.
//!
//! A gear says that the angle of a, less that of the carrier, is the ratio times that of b. Bodies that gears on one carrier join
//! therefore turn by fixed multiples of one of them.

use super::WorldBuilder;
use crate::world_error::WorldError;
use halfgap_collision::{BodyId, ConnectorKind, Coordinate};

/// Deviation of a product of ratios from 1 that is rounding [-].
const ROUNDED: f64 = 1e-9;

/// A body among those that gears on one carrier join.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Geared {
    carrier: BodyId,
    body: BodyId,
    /// Number of the set to which it belongs, and its turns for one turn of the set.
    set: usize,
    turns: f64,
    /// Index of the last connector that joined it to others.
    by: usize,
}

impl WorldBuilder {
    /// Refuses connectors that contradict each other in every state.
    pub(super) fn check_contradictions(&self) -> Result<(), WorldError> {
        let contradict = |first: usize, second: usize| {
            let names = [first, second].map(|index| self.connector_name(index));
            Err(WorldError::Contradiction { connectors: Box::new(names) })
        };
        if let Some([first, second]) = self.doubly_driven() {
            return contradict(first, second);
        }
        let mut geared: Vec<Geared> = Vec::new();
        for (index, spec) in self.connectors.iter().enumerate() {
            let ConnectorKind::Gear { a, b, carrier, ratio, .. } = spec.connector.kind else { continue };
            let place = |geared: &mut Vec<Geared>, body: BodyId| {
                let known = geared.iter().position(|one| (one.carrier, one.body) == (carrier, body));
                known.unwrap_or_else(|| {
                    let set = geared.len();
                    geared.push(Geared { carrier, body, set, turns: 1.0, by: index });
                    set
                })
            };
            let (of_a, of_b) = (place(&mut geared, a), place(&mut geared, b));
            let (one, other) = (geared[of_a], geared[of_b]);
            if one.set == other.set {
                let product = ratio * other.turns / one.turns;
                if (product - 1.0).abs() > ROUNDED {
                    let before = if one.by == index { other.by } else { one.by };
                    return contradict(before, index);
                }
                continue;
            }
            // The set of b turns along with that of a.
            let factor = one.turns / (ratio * other.turns);
            for joined in geared.iter_mut().filter(|joined| joined.set == other.set) {
                (joined.set, joined.turns) = (one.set, joined.turns * factor);
            }
            (geared[of_a].by, geared[of_b].by) = (index, index);
        }
        Ok(())
    }

    /// Two connectors that drive the angle between the same two bodies.
    fn doubly_driven(&self) -> Option<[usize; 2]> {
        let driven = |index: usize| {
            let spec = &self.connectors[index];
            spec.on_coordinate.drive.as_ref()?;
            match spec.connector.coordinate()? {
                Coordinate::Angle { a, b, .. } => Some([a.min(b), a.max(b)]),
                Coordinate::Along { .. } => None,
            }
        };
        let mut seen: Vec<([BodyId; 2], usize)> = Vec::new();
        for (index, bodies) in (0..self.connectors.len()).filter_map(|index| Some((index, driven(index)?))) {
            if let Some((_, first)) = seen.iter().find(|(other, _)| *other == bodies) {
                return Some([*first, index]);
            }
            seen.push((bodies, index));
        }
        None
    }
}
