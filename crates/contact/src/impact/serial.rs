//! Rows solved one after another, until none closes.
//!
//! Each round takes one closing row as the focus, alone or with those that close on the same bodies, and lets it rebound.
//! The rounds end because each takes energy out of the closing motion, or hands it on to rows that open; what still
//! ricochets after many rounds (bodies in a tight chain) is stopped without elasticity.

use super::Impact;
use super::law::{ImpactError, ROUNDS_PER_ROW};
use super::shuffle::Shuffle;

/// Which rows join the focus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Grouping {
    /// None.
    One,
    /// Those that close and share a movable body with it.
    SameBodies,
}

pub(super) fn resolve_serially(
    impact: &mut Impact,
    grouping: Grouping,
    mut shuffle: Option<&mut Shuffle>,
    small: f64,
) -> Result<(), ImpactError> {
    for _ in 0..ROUNDS_PER_ROW * impact.rows.len() {
        let Some(focus) = focus(impact, shuffle.as_deref_mut(), small) else { return Ok(()) };
        let mut set = std::mem::take(&mut impact.scratch.set);
        set.clear();
        match grouping {
            Grouping::One => set.push(focus),
            Grouping::SameBodies => {
                let joins = |row: &usize| {
                    *row == focus
                        || (impact.rates[*row] < -small
                            && impact.rows[*row].shares_movable_body(&impact.rows[focus]))
                };
                set.extend((0..impact.rows.len()).filter(joins));
            }
        }
        impact.aim_at_rebounds();
        let outcome = impact.solve_together(&set);
        impact.scratch.set = set;
        outcome?;
    }
    impact.solve_all_inelastic(small)
}

/// The row to solve next: the fastest, ties by place, or a random one of those that close.
fn focus(impact: &Impact, shuffle: Option<&mut Shuffle>, small: f64) -> Option<usize> {
    let closing = || (0..impact.rows.len()).filter(|&row| impact.rates[row] < -small);
    match shuffle {
        None => closing().min_by(|&p, &q| impact.rates[p].total_cmp(&impact.rates[q])),
        Some(shuffle) => {
            let count = closing().count();
            if count == 0 { None } else { closing().nth(shuffle.below(count)) }
        }
    }
}
