//! Compresses the JSON schemas of docs/schema for the command `chta schema`, since deriving them in the program takes ten times the bytes, and
//! the page of `chta report`, of which two thirds are three.js.

use std::{env, error::Error, fmt::Write as _, fs, io::Write as _, path::Path};

use flate2::{Compression, write::ZlibEncoder};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=docs/schema");
    println!("cargo::rerun-if-changed=report/dist/page.html");
    println!("cargo::rerun-if-changed=build.rs");
    let out = env::var("OUT_DIR")?;
    let mut files: Vec<_> = fs::read_dir("docs/schema")?.map(|entry| Ok(entry?.path())).collect::<Result<_, std::io::Error>>()?;
    files.sort();
    let mut list = "&[\n".to_owned();
    for file in files {
        let Some(name) = file.file_stem().and_then(|name| name.to_str()) else { continue };
        let compressed = Path::new(&out).join(format!("{name}.zlib"));
        fs::write(&compressed, zlib(&file)?)?;
        let compressed = compressed.to_str().ok_or("the folder of the build is no text")?;
        writeln!(list, "    ({name:?}, include_bytes!({compressed:?})),")?;
    }
    list.push_str("]\n");
    fs::write(Path::new(&out).join("schemas.rs"), list)?;
    fs::write(Path::new(&out).join("page.zlib"), zlib(Path::new("report/dist/page.html"))?)?;
    Ok(())
}

/// A file, compressed.
fn zlib(file: &Path) -> Result<Vec<u8>, std::io::Error> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&fs::read(file)?)?;
    encoder.finish()
}
