//! Checks of the numbers of a connector.

use super::Connector;
use super::error::ConnectorError;
use super::kind::ConnectorKind;
use super::path::SAME_PLACE;

/// Largest deviation of the length of a unit vector from 1 [-]: rounding.
const UNIT_ROUNDING: f64 = 8.0 * f64::EPSILON;

impl Connector {
    /// Checks a connector that was not made by [`new`](Self::new), or was changed since.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new); also a normal of a slot that is not a unit vector.
    pub fn check(&self) -> Result<(), ConnectorError> {
        if !(0.0..=1.0).contains(&self.elasticity) {
            return Err(ConnectorError::BadElasticity(self.elasticity));
        }
        self.check_numbers()?;
        let [a, b] = self.bodies();
        if a == b { Err(ConnectorError::SameBody) } else { Ok(()) }
    }

    fn check_numbers(&self) -> Result<(), ConnectorError> {
        if !self.anchors().into_iter().flatten().all(|anchor| anchor.point.is_finite()) {
            return Err(ConnectorError::NotFinite);
        }
        if let Some(direction) = self.kind.direction()
            && (direction.length() - 1.0).abs() > UNIT_ROUNDING
        {
            return Err(self.kind.bad_direction(direction.x, direction.y));
        }
        let finite = |values: &[f64]| {
            if values.iter().all(|value| value.is_finite()) { Ok(()) } else { Err(ConnectorError::NotFinite) }
        };
        let positive = |length: f64| {
            if length > 0.0 && length.is_finite() { Ok(()) } else { Err(ConnectorError::BadLength(length)) }
        };
        match &self.kind {
            ConnectorKind::Pin { .. } | ConnectorKind::Slot { .. } | ConnectorKind::Rail { .. } => Ok(()),
            ConnectorKind::Rod { length, .. } | ConnectorKind::Rope { length, .. } => positive(*length),
            ConnectorKind::RailStop { at, path, .. } => {
                // The length is a sum that is rounded, and so is the arc length of a stop at the path's end.
                let length = path.length();
                let fine = (0.0..=(1.0 + SAME_PLACE) * length).contains(at);
                if fine { Ok(()) } else { Err(ConnectorError::BadStop { at: *at, length }) }
            }
            ConnectorKind::Weld { turn, .. } | ConnectorKind::Slider { turn, .. } => {
                finite(&[turn.angle, turn.lever])
            }
            ConnectorKind::Gear { a, b, carrier, ratio, turn } => {
                if carrier == a || carrier == b {
                    return Err(ConnectorError::SameBody);
                }
                let fine = *ratio != 0.0 && ratio.is_finite();
                if fine { finite(&[turn.angle, turn.lever]) } else { Err(ConnectorError::BadRatio(*ratio)) }
            }
            ConnectorKind::Rack { radius, at, .. } => {
                let fine = *radius != 0.0 && radius.is_finite();
                if fine { finite(&[*at]) } else { Err(ConnectorError::BadRadius(*radius)) }
            }
            ConnectorKind::Pulley { wheels, ratio, length, .. } => {
                if !(*ratio > 0.0 && ratio.is_finite()) {
                    return Err(ConnectorError::BadRatio(*ratio));
                }
                let [a, b] = wheels;
                finite(&[a.x, a.y, b.x, b.y]).and_then(|()| positive(*length))
            }
            ConnectorKind::Limit { coordinate, at, .. } => finite(&[*at, coordinate.scale()]),
            ConnectorKind::Drive { coordinate, law, at } => {
                if law.is_finite() {
                    finite(&[*at, coordinate.scale()])
                } else {
                    Err(ConnectorError::NotFinite)
                }
            }
            ConnectorKind::Pull { coordinate, speed, most } => {
                if !(*most >= 0.0 && most.is_finite()) {
                    return Err(ConnectorError::BadPull(*most));
                }
                finite(&[*speed, coordinate.scale()])
            }
        }
    }
}
