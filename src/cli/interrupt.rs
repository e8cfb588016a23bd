//! Ctrl-C, and other requests to end: the work is cancelled at its next report, and no half file stays behind.

use std::{
    sync::atomic::{AtomicBool, Ordering},
    thread,
    time::Duration,
};

use super::whole_file::abandon_unfinished;

use super::{Failure, inputs};

/// What a program ended by Ctrl-C gives its shell: 128 and the signal's number.
pub(crate) const STATUS: u8 = 130;

/// How long the work has to report and to end by itself.
const GRACE: Duration = Duration::from_millis(500);

/// Whether an interrupt has come.
static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Handles interrupts from now on.
pub(crate) fn handle() {
    // Where the system refuses a handler, an interrupt ends the program as ever; a temporary file may then stay.
    let _ = ctrlc::set_handler(|| {
        if REQUESTED.swap(true, Ordering::Relaxed) {
            end();
        }
        // Reading a file, for one, reports nothing: the program ends in any case.
        let waits = thread::Builder::new().spawn(|| {
            thread::sleep(GRACE);
            end();
        });
        if waits.is_err() {
            end();
        }
    });
}

/// Whether an interrupt has come.
pub(crate) fn is_requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// Refuses to go on after an interrupt, so that no answer appears after it.
pub(crate) fn check() -> Result<(), Failure> {
    if is_requested() { Err(Failure::message("interrupted")) } else { Ok(()) }
}

/// Ends the program at once.
fn end() -> ! {
    abandon_unfinished();
    inputs::forget();
    #[expect(clippy::exit, reason = "work that goes on in other threads is not waited for")]
    std::process::exit(i32::from(STATUS));
}
