//! Ctrl-C and SIGTERM: the run stops, and what it has found up to then is printed and written.
//!
//! A run stops at its next event or output, or within a few steps. A second Ctrl-C ends the command at once; a second
//! SIGTERM does not, as some programs send each of them twice.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::{register, register_conditional_default};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Flag that a signal asked the command to stop.
#[derive(Debug)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens to signals from now on; where the system does not allow that, a signal ends the command as usual.
    pub(crate) fn listen() -> Self {
        let asked = Arc::new(AtomicBool::new(false));
        // The order matters: the first signal must find the flag unset.
        let heard = register_conditional_default(SIGINT, Arc::clone(&asked));
        let _ = heard.and_then(|_| register(SIGINT, Arc::clone(&asked)));
        let _ = register(SIGTERM, Arc::clone(&asked));
        Self(asked)
    }

    /// Returns `Break` if the command was asked to stop.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
