//! A long chain of one-metre segments over fractal ground, as CSV: what `benches/scale.sh` and `benches/peers` measure on.
//!
//! `cargo run --release --example long_chain -- --segments 100000 --seed 1 > chain.csv`
//!
//! The same numbers for the same seed, everywhere. Gravity, speeds and friction are the scenario's: see `benches/scale.sh`.

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
