//! Progress of computations longer than a second, shown only on a terminal.

use std::{
    io::{self, IsTerminal},
    sync::{
        Arc, Mutex,
        mpsc::{self, RecvTimeoutError, Sender},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

use indicatif::{ProgressBar, ProgressStyle};

/// Shows the current stage from the first second on, until it is dropped.
#[derive(Debug)]
pub(crate) struct Progress {
    doing: Arc<Mutex<String>>,
    shown: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Begins to watch. Silent where standard error is no terminal.
    pub(crate) fn new(quiet: bool) -> Self {
        let doing = Arc::new(Mutex::new(String::new()));
        let shown = (!quiet && io::stderr().is_terminal()).then(|| {
            let (done, wait) = mpsc::channel();
            let doing = Arc::clone(&doing);
            let thread = thread::spawn(move || {
                if wait.recv_timeout(Duration::from_secs(1)) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
                let bar = ProgressBar::new_spinner();
                if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
                    bar.set_style(style);
                }
                while wait.recv_timeout(Duration::from_millis(100)) == Err(RecvTimeoutError::Timeout) {
                    if let Ok(doing) = doing.lock() {
                        bar.set_message(doing.clone());
                    }
                    bar.tick();
                }
                bar.finish_and_clear();
            });
            (done, thread)
        });
        Self { doing, shown }
    }

    /// Sets the current stage.
    pub(crate) fn say(&self, doing: String) {
        if let Ok(mut said) = self.doing.lock() {
            *said = doing;
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((done, thread)) = self.shown.take() {
            drop(done);
            // A thread that failed to draw has nothing more to say.
            let _ = thread.join();
        }
    }
}
