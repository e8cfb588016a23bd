//! Writes a long chain of one-metre segments over fractal ground as CSV: the input of `benches/scale.sh` and `benches/peers`.
//!
//! `cargo run --release --example long_chain -- --segments 100000 --seed 1 > chain.csv`
//!
//! The same seed gives the same numbers on every platform. Gravity, speeds and friction come from a scenario: see `benches/scale.sh`.

#[path = "../benches/support/mod.rs"]
mod support;

use std::{
    error::Error,
    io::{self, BufWriter, Write},
};

use chta::chain::{PolygonalChain, csv::write_chain_csv};

fn main() -> Result<(), Box<dyn Error>> {
    let (mut segments, mut seed) = (100_000, 1);
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value: u64 = arguments.next().ok_or_else(|| format!("{name}: expected a whole number after it"))?.parse()?;
        match name.as_str() {
            "--segments" => segments = usize::try_from(value)?.clamp(1, 10_000_000),
            "--seed" => seed = value,
            _ => return Err(format!("found {name}, expected --segments N or --seed S").into()),
        }
    }
    let chain = PolygonalChain::bare(support::long_chain(segments, seed))?;
    let mut out = BufWriter::new(io::stdout().lock());
    write_chain_csv(&chain, &mut out, &[format!("long_chain: {segments} segments, seed {seed}")])?;
    Ok(out.flush()?)
}
