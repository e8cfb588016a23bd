//! Names of files in the commands of messages.

use std::path::Path;

/// A path as one word of a shell, quoted where it needs that.
pub fn shell_word(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = text.chars().all(|letter| letter.is_alphanumeric() || "/._-+:".contains(letter));
    if plain { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quotes: POSIX shell, 2.2.2.
    #[test]
    fn only_what_a_shell_would_change_is_quoted() {
        for (name, word) in [
            ("a/b-1.tif", "a/b-1.tif"),
            ("C:/x.tif", "C:/x.tif"),
            ("höhe.tif", "höhe.tif"),
            ("two words.tif", "'two words.tif'"),
            ("it's.tif", r"'it'\''s.tif'"),
            ("$HOME.tif", "'$HOME.tif'"),
        ] {
            assert_eq!(shell_word(Path::new(name)), word);
        }
    }
}
