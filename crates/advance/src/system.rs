//! What a system must be able to do to be advanced event by event, and the loop that does it.

use crate::time::Time;
use std::ops::ControlFlow;

/// A system that predicts its events and handles them one by one.
pub trait EventDriven {
    /// What is told of a handled event.
    type Report;
    /// Why an event could not be handled.
    type Error;

    /// Time of the earliest event; `None` if nothing will ever happen.
    fn next_event(&self) -> Option<Time>;

    /// Handles the earliest event; `None` if it was of no interest to anyone outside.
    ///
    /// # Errors
    /// The event cannot be handled; the system stays at the time of the event.
    fn handle_next(&mut self) -> Result<Option<Self::Report>, Self::Error>;

    /// All events up to some time have been handled, and somebody will look: what was put off must be there
    /// now. So it must be, too, after each event that is told of.
    fn arrive(&mut self) {}
}

/// Handles all events up to and including `until`, in order, telling `on_report` of each; none if `until` is no number.
///
/// # Errors
/// The first event that cannot be handled; what was told before stands.
pub fn advance_until<S: EventDriven>(
    system: &mut S,
    until: Time,
    mut on_report: impl FnMut(&S, &S::Report),
) -> Result<(), S::Error> {
    let outcome = advance_while(system, until, |system, report| {
        on_report(system, report);
        ControlFlow::Continue(())
    });
    outcome.map(|_| ())
}

/// The same, but no further than the first event of which `on_report` says [`ControlFlow::Break`]. Those that
/// come after it, be it at the same time, are handled by the next advance, just as if it had not stopped.
///
/// # Errors
/// As [`advance_until`].
pub fn advance_while<S: EventDriven>(
    system: &mut S,
    until: Time,
    mut on_report: impl FnMut(&S, &S::Report) -> ControlFlow<()>,
) -> Result<ControlFlow<()>, S::Error> {
    let is_number = !until.seconds().is_nan();
    while is_number && system.next_event().is_some_and(|time| time <= until) {
        if let Some(report) = system.handle_next()?
            && on_report(system, &report).is_break()
        {
            return Ok(ControlFlow::Break(()));
        }
    }
    system.arrive();
    Ok(ControlFlow::Continue(()))
}
