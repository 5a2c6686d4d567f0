//! A piece of a path of edges: part of a straight line or of a circle.

use super::path::Foot;
use glam::DVec2;
use halfgap_geometry::{Arc, DirectionRange, Edge};
use std::f64::consts::TAU;

/// A piece of a path; places along it are measured from its first point [m].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct EdgePiece {
    curve: PieceCurve,
    /// Arc length of the path at the piece's place 0 [m].
    pub(super) start: f64,
    /// First and last place [m], infinite for a continuation.
    pub(super) range: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
enum PieceCurve {
    Straight {
        from: DVec2,
        direction: DVec2,
    },
    Round {
        center: DVec2,
        radius: f64,
        /// +1 counter-clockwise, -1 clockwise.
        sign: f64,
        /// Unit vector from the center to the middle of the arc.
        middle: DVec2,
        directions: DirectionRange,
        ends: [DVec2; 2],
    },
}

impl EdgePiece {
    pub(super) fn new(edge: &Edge, start: f64) -> Self {
        let curve = match edge {
            Edge::Line(line) => PieceCurve::Straight { from: line.from(), direction: line.direction() },
            Edge::Arc(arc) => round(arc),
        };
        Self { curve, start, range: [0.0, edge.length()] }
    }

    /// The straight continuation of a path through its end `from`.
    pub(super) fn ray(from: DVec2, direction: DVec2, start: f64, range: [f64; 2]) -> Self {
        Self { curve: PieceCurve::Straight { from, direction }, start, range }
    }

    pub(super) fn curvature(&self) -> f64 {
        match self.curve {
            PieceCurve::Straight { .. } => 0.0,
            PieceCurve::Round { radius, sign, .. } => sign / radius,
        }
    }

    /// Place half-way along the piece [m].
    pub(super) fn half_way(&self) -> f64 {
        0.5 * (self.range[0] + self.range[1])
    }

    /// Squared distance [m^2] of a point from the piece.
    #[inline]
    pub(super) fn distance_sq(&self, point: DVec2) -> f64 {
        match &self.curve {
            PieceCurve::Straight { from, direction } => {
                let along = direction.dot(point - *from).clamp(self.range[0], self.range[1]);
                (point - (*from + *direction * along)).length_squared()
            }
            PieceCurve::Round { center, radius, directions, ends, .. } => {
                let offset = point - *center;
                let distance = offset.length();
                if distance == 0.0 || directions.contains(offset / distance) {
                    return (distance - radius) * (distance - radius);
                }
                (point - ends[0]).length_squared().min((point - ends[1]).length_squared())
            }
        }
    }

    /// Place [m] along the piece's line or circle that is nearest to a point; on a circle, in the lap nearest to the
    /// place `near` [m].
    pub(super) fn along(&self, point: DVec2, near: f64) -> f64 {
        match &self.curve {
            PieceCurve::Straight { from, direction } => direction.dot(point - *from),
            PieceCurve::Round { center, radius, sign, middle, .. } => {
                let offset = point - *center;
                let angle = sign * libm::atan2(middle.perp_dot(offset), middle.dot(offset));
                let along = self.half_way() + radius * angle;
                let lap = radius * TAU;
                along + lap * ((near - along) / lap).round()
            }
        }
    }

    /// The foot of a point on the piece's line or circle.
    #[inline]
    pub(super) fn foot(&self, piece: usize, point: DVec2) -> Foot {
        match &self.curve {
            PieceCurve::Straight { from, direction } => {
                let seen = point - *from;
                let foot = *from + *direction * direction.dot(seen);
                self.place(piece, foot, *direction, direction.perp().dot(seen))
            }
            PieceCurve::Round { center, radius, sign, middle, .. } => {
                let offset = point - *center;
                let distance = offset.length();
                let away = if distance > 0.0 { offset / distance } else { *middle };
                let foot = *center + away * *radius;
                self.place(piece, foot, away.perp() * *sign, sign * (radius - distance))
            }
        }
    }

    /// The foot at a place along the piece [m].
    pub(super) fn foot_at(&self, piece: usize, along: f64) -> Foot {
        match &self.curve {
            PieceCurve::Straight { from, direction } => {
                self.place(piece, *from + *direction * along, *direction, 0.0)
            }
            PieceCurve::Round { center, radius, sign, middle, .. } => {
                let angle = sign * (along - self.half_way()) / radius;
                let (sin, cos) = libm::sincos(angle);
                let away = *middle * cos + middle.perp() * sin;
                self.place(piece, *center + away * *radius, away.perp() * *sign, 0.0)
            }
        }
    }

    #[inline]
    fn place(&self, piece: usize, point: DVec2, tangent: DVec2, gap: f64) -> Foot {
        Foot {
            piece: u32::try_from(piece).unwrap_or(u32::MAX),
            parameter: 0.0,
            point,
            tangent,
            normal: tangent.perp(),
            curvature: self.curvature(),
            curvature_rate: 0.0,
            gap,
        }
    }
}

fn round(arc: &Arc) -> PieceCurve {
    PieceCurve::Round {
        center: arc.center(),
        radius: arc.radius(),
        sign: if arc.is_convex() { 1.0 } else { -1.0 },
        middle: arc.middle_direction(),
        directions: arc.directions(),
        ends: [arc.from(), arc.to()],
    }
}
