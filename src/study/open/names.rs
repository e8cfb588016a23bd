//! The names of files in results.

use std::path::{Component, Path};

/// A file's path relative to the working folder, normalised and with `/`, so that results are the same on every platform.
pub fn relative_name(path: &Path) -> String {
    let here = std::env::current_dir().unwrap_or_default();
    let absolute = normal(&here.join(path));
    let here = normal(&here);
    let shared = absolute.iter().zip(&here).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_owned(), here.len() - shared);
    up.chain(absolute[shared..].iter().cloned()).collect::<Vec<_>>().join("/")
}

/// The parts of a path, with `.` and `..` resolved as text.
fn normal(path: &Path) -> Vec<String> {
    let mut parts = Vec::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                parts.pop();
            }
            Component::Prefix(_) | Component::RootDir | Component::Normal(_) => {
                parts.push(component.as_os_str().to_string_lossy().into_owned());
            }
        }
    }
    parts
}
