//! The threads of the computation.

use super::Failure;

/// Sets the number of threads; 0: one for each core.
pub(crate) fn use_threads(threads: usize) -> Result<(), Failure> {
    if threads == 0 {
        // This is the default, and small searches never start the threads.
        return Ok(());
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::message(format!("the threads cannot be started ({error}): ask for fewer with --threads")))
}
