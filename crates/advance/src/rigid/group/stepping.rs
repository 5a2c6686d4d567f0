//! The steppers of a system, and the choice among them.

use crate::ode::{Method, Stepper};

/// The method of brief steps.
pub(crate) const BRIEF_METHOD: Method = Method::DormandPrince5;

/// Stepper by which the steps of a group are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stepping {
    /// That of the method asked for.
    Asked,
    /// That of the method with few stages.
    Brief,
    /// The implicit one.
    Stiff,
}

/// The steppers of a system.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Steppers {
    asked: Stepper,
    brief: Stepper,
    stiff: Stepper,
}

impl Steppers {
    pub(crate) fn new(method: Method) -> Self {
        Self {
            asked: Stepper::new(method),
            brief: Stepper::new(BRIEF_METHOD),
            stiff: Stepper::new(Method::RadauIia5),
        }
    }

    pub(crate) fn of(&mut self, stepping: Stepping) -> &mut Stepper {
        match stepping {
            Stepping::Asked => &mut self.asked,
            Stepping::Brief => &mut self.brief,
            Stepping::Stiff => &mut self.stiff,
        }
    }
}
