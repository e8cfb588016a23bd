//! Any bytes as a chain CSV: no panic, spans inside their text, and an accepted file reads back equal after writing.
#![no_main]

use chta::chain::csv::{read_chain_csv, write_chain_csv};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match read_chain_csv(bytes) {
        Ok(file) => {
            let mut written = Vec::new();
            write_chain_csv(&file.chain, &mut written, &[]).expect("a chain that was read can be written");
            let again = read_chain_csv(&written).expect("a chain that was written can be read");
            assert_eq!(again.chain, file.chain);
        }
        Err(problems) => {
            assert!(!problems.is_empty());
            for problem in &problems.problems {
                assert!(problem.text.get(problem.span.clone()).is_some(), "{problem:?}");
            }
            assert!(problems.to_string().len() < 100_000);
        }
    }
});
