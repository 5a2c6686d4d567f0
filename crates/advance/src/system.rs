//! The trait of systems that are advanced event by event, and the loop that advances them.

use crate::time::Time;
use std::ops::ControlFlow;

/// A system that predicts its events and handles them one by one.
pub trait EventDriven {
    /// Report of a handled event, passed to the caller of the loop.
    type Report;
    /// Error of an event that cannot be handled.
    type Error;

    /// Time of the earliest event; `None` if nothing will ever happen.
    fn next_event(&self) -> Option<Time>;

    /// Handles the earliest event and returns its report; `None` if callers need not know of it.
    ///
    /// # Errors
    /// The event cannot be handled; the system stays at the time of the event.
    fn handle_next(&mut self) -> Result<Option<Self::Report>, Self::Error>;

    /// Called after all events up to the target, before the caller reads the state: finish deferred work here. Reported
    /// events must leave it finished too.
    fn arrive(&mut self) {}
}

/// Handles all events up to and including `until`, in order, and calls `on_report` with the report of each. A NaN makes
/// [`Time::NEVER`], with which the loop ends only when no event is left, not even one at that time.
///
/// # Errors
/// The first event that cannot be handled; events reported before it stay handled.
#[inline]
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

/// Handles events up to and including `until`, in order, but none after the first report to which `on_report` answers
/// [`ControlFlow::Break`]. The next advance handles the events that follow, also those of the same time, as if the loop
/// had not stopped.
///
/// # Errors
/// The first event that cannot be handled; events reported before it stay handled.
#[inline]
pub fn advance_while<S: EventDriven>(
    system: &mut S,
    until: Time,
    mut on_report: impl FnMut(&S, &S::Report) -> ControlFlow<()>,
) -> Result<ControlFlow<()>, S::Error> {
    advance_watched(system, until, |system, report| match report {
        Some(report) => on_report(system, report),
        None => ControlFlow::Continue(()),
    })
}

/// Advances like [`advance_while`], but calls `on_event` also after events that have no report: a caller can tell how
/// far a long advance has come, and break it off.
///
/// # Errors
/// The first event that cannot be handled; events reported before it stay handled.
pub fn advance_watched<S: EventDriven>(
    system: &mut S,
    until: Time,
    mut on_event: impl FnMut(&S, Option<&S::Report>) -> ControlFlow<()>,
) -> Result<ControlFlow<()>, S::Error> {
    let is_number = !until.seconds().is_nan();
    while is_number && system.next_event().is_some_and(|time| time <= until) {
        let report = system.handle_next()?;
        if on_event(system, report.as_ref()).is_break() {
            if report.is_none() {
                system.arrive();
            }
            return Ok(ControlFlow::Break(()));
        }
    }
    system.arrive();
    Ok(ControlFlow::Continue(()))
}
