//! Progress of computations longer than a second, shown only on a terminal, and their cancellation by an interrupt.

use std::{
    io::{self, IsTerminal},
    ops::ControlFlow,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, RecvTimeoutError, Sender},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use chta::{
    progress::{Detail, Stage, Step},
    uncertainty::Policy,
};
use indicatif::{ProgressBar, ProgressStyle};

use super::{interrupt, verbose};

/// Shows the current stage from the first second on, until it is dropped; cancels the stage after an interrupt.
#[derive(Debug)]
pub(crate) struct Progress {
    doing: Arc<Mutex<String>>,
    shown: Option<(Sender<()>, JoinHandle<()>)>,
    stopped: AtomicBool,
    /// The policy of the trials under way, and when they began.
    trials: Mutex<Option<(Policy, Instant)>>,
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
        Self { doing, shown, stopped: AtomicBool::new(false), trials: Mutex::new(None) }
    }

    /// The trials of a policy begin.
    pub(crate) fn begin_trials(&self, policy: Policy) {
        if let Ok(mut trials) = self.trials.lock() {
            *trials = Some((policy, Instant::now()));
        }
    }

    /// Sets the current stage.
    fn say(&self, doing: String) {
        if let Ok(mut said) = self.doing.lock() {
            *said = doing;
        }
    }

    /// Cancels the work at its next report.
    pub(crate) fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// The same, with lines of one's own; `None` leaves the last line as it is.
    pub(crate) const fn with_lines<F: Fn(&Step) -> Option<String> + Sync>(&self, line: F) -> Lines<'_, F> {
        Lines { progress: self, line }
    }
}

impl chta::progress::Progress for Progress {
    fn report(&self, step: &Step) -> ControlFlow<()> {
        let line = |step: &Step| match (step.detail, step.of) {
            (Detail::Trials { reached_goal }, Some(of)) => {
                let (policy, begun) = (*self.trials.lock().ok()?)?;
                Some(trials_line(policy, (step.done, of), reached_goal, begun.elapsed().as_secs_f64()))
            }
            _ => line(step),
        };
        self.with_lines(line).report(step)
    }
}

/// Progress with lines of one's own.
#[derive(Debug)]
pub(crate) struct Lines<'a, F> {
    progress: &'a Progress,
    line: F,
}

impl<F: Fn(&Step) -> Option<String> + Sync> chta::progress::Progress for Lines<'_, F> {
    fn report(&self, step: &Step) -> ControlFlow<()> {
        if interrupt::is_requested() || self.progress.stopped.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        verbose::step(step, || detail(step));
        if self.progress.shown.is_some()
            && let Some(line) = (self.line)(step)
        {
            self.progress.say(line);
        }
        ControlFlow::Continue(())
    }
}

/// The line of a step that says what is tried.
fn detail(step: &Step) -> Option<String> {
    Some(match (step.stage, step.detail) {
        (Stage::Search, Detail::PointsPerSegment(points)) => format!("searching with {points} points inside each segment"),
        (Stage::Search, Detail::NodeSpacingM(spacing_m)) => format!("searching with nodes at most {spacing_m} m apart"),
        (Stage::Proof, Detail::ProofRound { cells, round }) => format!("proving with {cells} cells, round {round}"),
        _ => return None,
    })
}

/// The line of a step.
fn line(step: &Step) -> Option<String> {
    Some(match (step.stage, step.detail) {
        (Stage::Search | Stage::Proof, _) => return detail(step),
        (Stage::Trade, _) => format!("{} of {} fields", step.done, step.of?),
        (Stage::Fan, _) => format!("{} of {} headings", step.done, step.of?),
        (Stage::CostToGo, _) => "ranking the successors of every node".to_owned(),
        (Stage::Reliability, _) => format!("estimating the reliability of hops: {} pairs", step.pairs),
        _ => return None,
    })
}

/// The line of trials: trials done, trials per second and time left.
#[expect(clippy::cast_precision_loss, reason = "for reading")]
fn trials_line(policy: Policy, (done, of): (u64, u64), reached_goal: u64, elapsed_s: f64) -> String {
    let rate = done as f64 / elapsed_s.max(1e-9);
    let left_s = (of - done.min(of)) as f64 / rate.max(1e-9);
    format!(
        "{}: {done} of {of} trials, {rate:.0} a second, {left_s:.0} s left at most, {:.4} reach the goal",
        policy.name(),
        reached_goal as f64 / done.max(1) as f64
    )
}

impl Drop for Progress {
    fn drop(&mut self) {
        verbose::stage_is_over();
        if let Some((done, thread)) = self.shown.take() {
            drop(done);
            // A thread that failed to draw has nothing more to say.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_trials_has_rate_and_time_left() {
        assert_eq!(
            trials_line(Policy::Replan, (3000, 9000), 1500, 2.0),
            "replan: 3000 of 9000 trials, 1500 a second, 4 s left at most, 0.5000 reach the goal"
        );
    }
}
