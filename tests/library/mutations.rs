//! What the mutations of all readers share.

use std::ops::Range;

use rand::{RngExt, rngs::ChaCha8Rng};

/// Number of mutations of each kind of file: `CHTA_MUTATIONS`, or ten thousand.
pub(crate) fn rounds() -> usize {
    match std::env::var("CHTA_MUTATIONS") {
        Ok(text) => text.parse().unwrap_or_else(|_| panic!("CHTA_MUTATIONS is '{text}', expected a whole number")),
        Err(_) => 10_000,
    }
}

/// Mutates bytes, mostly in one position, else in up to four. `mutate` gets each range: the position and up to 30 bytes after it.
pub(crate) fn mutated(
    rng: &mut ChaCha8Rng,
    original: &[u8],
    mutate: impl Fn(&mut ChaCha8Rng, &mut Vec<u8>, Range<usize>),
) -> Vec<u8> {
    let mut bytes = original.to_vec();
    let places = if rng.random_bool(0.6) { 1 } else { rng.random_range(2..=4) };
    for _ in 0..places {
        if bytes.is_empty() {
            break;
        }
        let at = rng.random_range(0..bytes.len());
        let end = rng.random_range(at..=bytes.len().min(at + 30));
        mutate(rng, &mut bytes, at..end);
    }
    bytes
}

/// Copies a range to a random position.
pub(crate) fn copy(rng: &mut ChaCha8Rng, bytes: &mut Vec<u8>, range: Range<usize>) {
    let piece = bytes[range].to_vec();
    let to = rng.random_range(0..=bytes.len());
    bytes.splice(to..to, piece);
}

/// Replaces a digit by another: the change that most likely passes every check.
pub(crate) fn replace_digit(rng: &mut ChaCha8Rng, bytes: &mut [u8]) {
    let digits: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i].is_ascii_digit()).collect();
    if !digits.is_empty() {
        bytes[digits[rng.random_range(0..digits.len())]] = rng.random_range(b'0'..=b'9');
    }
}

/// Rarely truncates at a position, so that most of a file remains; else draws that byte anew.
pub(crate) fn truncate_or_redraw(rng: &mut ChaCha8Rng, bytes: &mut Vec<u8>, at: usize) {
    if rng.random_bool(0.2) {
        bytes.truncate(at);
    } else {
        bytes[at] = rng.random();
    }
}
