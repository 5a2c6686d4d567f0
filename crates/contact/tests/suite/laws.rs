//! All impact laws, and the orders in which serial ones take their rows.

use halfgap_contact::{ImpactLaw, ImpactOrder};

pub(crate) const LAWS: [ImpactLaw; 6] = [
    ImpactLaw::Simultaneous,
    ImpactLaw::Hybrid,
    ImpactLaw::SerialSeparate,
    ImpactLaw::SerialGrouped,
    ImpactLaw::SerialSeparateLastpass,
    ImpactLaw::SerialGroupedLastpass,
];
pub(crate) const ORDERS: [ImpactOrder; 2] = [ImpactOrder::Fastest, ImpactOrder::Seeded(7)];
