//! Zones of distance around the target gap; the predicates built on them are in `gap_state`.

use crate::tolerances::Tolerances;

/// Zone of a distance relative to the target gap, from far to overlapping.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Zone {
    /// 0: farther than `distance_tol`.
    OutOfRange,
    /// 1: in range, but beyond the target zone.
    BeyondTarget,
    /// 2: in the target zone, within `accuracy` of the target gap.
    Target,
    /// 3: nearer than the target zone, not overlapping.
    Near,
    /// 4: overlapping; if the target zone reaches below 0, as that of a connector does, deeper than the target zone.
    Penetrating,
}

impl Zone {
    /// The zone of a distance [m], negative for overlap.
    #[must_use]
    #[inline]
    pub fn of(distance: f64, tolerances: &Tolerances) -> Self {
        let Tolerances { target_gap, accuracy, .. } = *tolerances;
        if distance < (target_gap - accuracy).min(0.0) {
            Zone::Penetrating
        } else if distance < target_gap - accuracy {
            Zone::Near
        } else if distance <= target_gap + accuracy {
            Zone::Target
        } else if distance <= tolerances.distance_tol() {
            Zone::BeyondTarget
        } else {
            Zone::OutOfRange
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_follow_the_distance_inwards() {
        let tolerances = Tolerances { target_gap: 0.005, accuracy: 0.003, velocity_tol: 0.5 };
        let zones = [0.0101, 0.0099, 0.0081, 0.0079, 0.0021, 0.0019, 0.0, -1e-9];
        let expected = [
            Zone::OutOfRange,
            Zone::BeyondTarget,
            Zone::BeyondTarget,
            Zone::Target,
            Zone::Target,
            Zone::Near,
            Zone::Near,
            Zone::Penetrating,
        ];
        assert_eq!(zones.map(|distance| Zone::of(distance, &tolerances)), expected);
    }
}
