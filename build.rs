//! Compresses the JSON schemas of docs/schema for the command `chta schema`: deriving them in the program takes ten times the bytes.

use std::{env, error::Error, fmt::Write as _, fs, io::Write as _, path::Path};

use flate2::{Compression, write::ZlibEncoder};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=docs/schema");
    println!("cargo::rerun-if-changed=build.rs");
    let out = env::var("OUT_DIR")?;
    let mut files: Vec<_> = fs::read_dir("docs/schema")?.map(|entry| Ok(entry?.path())).collect::<Result<_, std::io::Error>>()?;
    files.sort();
    let mut list = "&[\n".to_owned();
    for file in files {
        let Some(name) = file.file_stem().and_then(|name| name.to_str()) else { continue };
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&fs::read(&file)?)?;
        let compressed = Path::new(&out).join(format!("{name}.zlib"));
        fs::write(&compressed, encoder.finish()?)?;
        let compressed = compressed.to_str().ok_or("the folder of the build is no text")?;
        writeln!(list, "    ({name:?}, include_bytes!({compressed:?})),")?;
    }
    list.push_str("]\n");
    fs::write(Path::new(&out).join("schemas.rs"), list)?;
    Ok(())
}
