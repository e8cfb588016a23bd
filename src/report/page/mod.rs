//! An answer as a page: its documents and its ground in one HTML file that loads nothing from elsewhere.
//!
//! The page itself is the bundle of the folder `report`, which the build script compresses. Its script shows numbers of the documents alone,
//! which stand in it unchanged; the ground is there to be drawn.

mod ground;

use std::{fmt::Write as _, io::Read as _};

use flate2::read::ZlibDecoder;

pub use ground::{PageFacets, PageGround, PageLayer, PagePosts, ProfileCut, ProfilePiece};

/// The bundle, compressed.
const BUNDLE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/page.zlib"));

/// Where the documents stand in the bundle.
const MARK: &str = "<template id=\"documents\"></template>";

/// A document of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PageDocument {
    /// The name under which the page saves it, such as `result.json`.
    pub name: &'static str,
    /// Its text, as it was written.
    pub text: String,
}

/// The page without documents: the bundle of the folder `report`, byte by byte.
///
/// # Errors
/// An error of the decompression; the bundle of a sound program causes none.
pub fn page_template() -> std::io::Result<String> {
    let mut template = String::new();
    ZlibDecoder::new(BUNDLE).read_to_string(&mut template)?;
    Ok(template)
}

/// The page of an answer. The same documents and ground give the same bytes.
///
/// # Errors
/// An error of the decompression, or of the serialiser for a ground with numbers that JSON does not have.
pub fn page_html(documents: &[PageDocument], ground: &PageGround) -> std::io::Result<String> {
    let template = page_template()?;
    let (before, after) = template.split_once(MARK).unwrap_or((&template, ""));
    let mut page = before.to_owned();
    for PageDocument { name, text } in documents {
        let text = in_script(text.trim_end());
        // Writing to a String cannot fail.
        let _ = writeln!(page, "<script type=\"application/json\" class=\"answer\" data-name=\"{name}\">\n{text}\n</script>");
    }
    let ground = in_script(&serde_json::to_string(ground)?);
    let _ = write!(page, "<script type=\"application/json\" id=\"ground\">{ground}</script>");
    page.push_str(after);
    Ok(page)
}

/// A JSON text that cannot end the element it stands in: `<` occurs in strings alone, and is escaped there.
fn in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_stand_in_the_page_and_cannot_leave_their_element() {
        let text = "{\"title\": \"</script><script>alert(1)</script>\"}\n".to_owned();
        let page = page_html(&[PageDocument { name: "result.json", text: text.clone() }], &PageGround::default()).unwrap();
        assert!(!page.contains("alert(1)</script>\"}"), "the text ends its element");
        let start = page.find("data-name=\"result.json\">").unwrap();
        let inside = &page[start..][..page[start..].find("</script>").unwrap()];
        let json = inside.split_once('>').unwrap().1;
        let (read, given): (serde_json::Value, serde_json::Value) =
            (serde_json::from_str(json).unwrap(), serde_json::from_str(&text).unwrap());
        assert_eq!(read, given);
        assert!(page.contains("<script type=\"application/json\" id=\"ground\">{}</script>"));
    }

    #[test]
    fn the_policy_of_the_page_allows_its_own_script_and_style_alone() {
        use base64::{Engine as _, engine::general_purpose::STANDARD};
        use sha2::{Digest as _, Sha256};
        let template = page_template().unwrap();
        let inside = |open: &str, close: &str| {
            let from = template.rfind(open).unwrap() + open.len();
            &template[from..from + template[from..].find(close).unwrap()]
        };
        let hash = |text: &str| format!("sha256-{}", STANDARD.encode(Sha256::digest(text)));
        let script = hash(inside("\n<script>", "</script>"));
        let style = hash(inside("<style>", "</style>"));
        let policy = format!(
            "content=\"default-src 'none'; script-src '{script}'; style-src '{style}'; base-uri 'none'; form-action 'none'\""
        );
        assert!(template.contains(&policy), "expected {policy}");
        assert_eq!(template.matches(MARK).count(), 1);
        assert!(!template.contains("http-equiv=\"refresh\"") && !template.contains("src=\"http"));
    }
}
