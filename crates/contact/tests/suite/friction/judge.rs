//! A check of answers with friction that shares no code with the crate.

use halfgap_contact::{Problem, RowKind};

/// Largest violation of the rules, in units of the load: of the cones, of complementarity, and of the direction of
/// friction against slip.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Judged {
    pub(crate) cone: f64,
    pub(crate) complementarity: f64,
    pub(crate) direction: f64,
    /// Largest sum of the terms of an acceleration.
    pub(crate) growth: f64,
}

impl Judged {
    /// Whether the answer is right: to rounding, where that suffices, else in units of its terms.
    pub(crate) fn good(&self) -> bool {
        let worst = self.cone.max(self.complementarity).max(self.direction);
        worst <= 1e-12 || (self.growth >= 1e3 && self.growth < 1e12 && worst <= 1e-14 * (1.0 + self.growth))
    }
}

/// Judges forces by the entries of A.
pub(crate) fn judge(problem: &Problem, force: &[f64]) -> Judged {
    let (a, b) = (problem.dense(), problem.offset());
    let scale: Vec<f64> = (0..b.len()).map(|i| if a[i][i] > 0.0 { a[i][i].sqrt() } else { 1.0 }).collect();
    let load = b.iter().zip(&scale).map(|(b, s)| (b / s).abs()).fold(0.0, f64::max);
    let load = if load > 0.0 { load } else { 1.0 };
    let mut judged = Judged::default();
    for (row, entries) in a.iter().enumerate() {
        let terms = entries.iter().zip(force).map(|(x, f)| x * f);
        let acceleration = (terms.clone().sum::<f64>() + b[row]) / scale[row] / load;
        judged.growth = judged.growth.max(terms.map(f64::abs).sum::<f64>() / scale[row] / load);
        let own = force[row] * scale[row] / load;
        let (least, most) = match problem.kind(row) {
            RowKind::Unilateral => (0.0, f64::INFINITY),
            RowKind::Friction { normal, coefficient } => {
                let most = coefficient * force[normal].max(0.0) * scale[row] / load;
                (-most, most)
            }
            RowKind::Bounded { least, most } => (least * scale[row] / load, most * scale[row] / load),
            _ => (f64::NEG_INFINITY, f64::INFINITY),
        };
        judged.cone = judged.cone.max(least - own).max(own - most);
        // What is left of the force to its bounds where the acceleration wants more of it.
        let room = if acceleration > 0.0 { own - least } else { most - own };
        let wrong = room.max(0.0).min(acceleration.abs());
        let part = match problem.kind(row) {
            RowKind::Friction { .. } | RowKind::Bounded { .. } => &mut judged.direction,
            _ => &mut judged.complementarity,
        };
        *part = part.max(wrong);
    }
    judged
}
