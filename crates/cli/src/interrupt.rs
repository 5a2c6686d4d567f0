//! Ctrl-C and the request to terminate: what has been recorded by then is written all the same.
//!
//! A run stops at its next event or output. Whoever presses Ctrl-C once more is obeyed at once, as if nobody
//! listened; not who sends a second SIGTERM, as some programs send each of them twice.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::{register, register_conditional_default};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the command was asked to stop; by default nobody listens.
#[derive(Debug, Default)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens from now on; where the system does not let it, a signal ends the command as it always does.
    pub(crate) fn listen() -> Self {
        let asked = Arc::new(AtomicBool::new(false));
        // In this order: the first signal finds nothing asked yet.
        let heard = register_conditional_default(SIGINT, Arc::clone(&asked));
        let _ = heard.and_then(|_| register(SIGINT, Arc::clone(&asked)));
        let _ = register(SIGTERM, Arc::clone(&asked));
        Self(asked)
    }

    /// Whether to go on.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
