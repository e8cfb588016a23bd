//! The language of labels: `KEY = VALUE <UNIT>` in nested objects, up to `END`.

use crate::terrain::TerrainError;

/// The longest label; a longer text is not a label.
pub(super) const LONGEST_LABEL: usize = 1 << 20;

/// The deepest nesting of objects and of parentheses.
const DEEPEST: usize = 16;

/// A label, statement by statement.
#[derive(Debug, Default)]
pub(super) struct Label {
    statements: Vec<Statement>,
}

#[derive(Debug)]
struct Statement {
    /// Names of the objects around it, outermost first.
    objects: Vec<String>,
    key: String,
    values: Vec<Value>,
}

/// One value; sequences and sets have several.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Value {
    /// The text without quotes.
    pub(super) text: String,
    /// The unit in angle brackets, in capitals.
    pub(super) unit: Option<String>,
}

impl Label {
    /// Reads the text up to its END.
    ///
    /// # Errors
    /// [`TerrainError::Damaged`] with the line where the text is not a label.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, TerrainError> {
        let mut reader = Reader { bytes, at: 0, line: 1 };
        reader.skip_envelope();
        let mut objects: Vec<String> = Vec::new();
        let mut label = Self::default();
        loop {
            reader.skip_space();
            let key = reader.word().to_ascii_uppercase();
            match key.as_str() {
                "" => return Err(reader.damaged("no further statement and no END")),
                "END" => return Ok(label),
                "END_OBJECT" | "END_GROUP" => {
                    if reader.equals() {
                        reader.values()?;
                    }
                    if objects.pop().is_none() {
                        return Err(reader.damaged(&format!("{key} without an open object")));
                    }
                    continue;
                }
                _ => {}
            }
            if !reader.equals() {
                return Err(reader.damaged(&format!("no '=' after {}", shown(&key))));
            }
            let values = reader.values()?;
            if key == "OBJECT" || key == "GROUP" {
                if objects.len() == DEEPEST {
                    return Err(reader.damaged("objects nested too deeply"));
                }
                objects.push(values.first().map(|value| value.text.to_ascii_uppercase()).unwrap_or_default());
            } else {
                label.statements.push(Statement { objects: objects.clone(), key, values });
            }
        }
    }

    /// All statements, each with the names of the objects around it (outermost first), its key and its values.
    pub(super) fn statements(&self) -> impl Iterator<Item = (&[String], &str, &[Value])> {
        self.statements.iter().map(|statement| (&*statement.objects, &*statement.key, &*statement.values))
    }

    /// Whether the label has an object of the name, anywhere.
    pub(super) fn has(&self, object: &str) -> bool {
        self.statements.iter().any(|statement| statement.objects.iter().any(|name| name == object))
    }

    /// The values of a key in an object (anywhere in the label), or outside all objects except FILE if `object` is empty.
    ///
    /// # Errors
    /// [`TerrainError::Unsuitable`] if the label gives the key several times with different values.
    pub(super) fn values(&self, object: &str, key: &str) -> Result<Option<&[Value]>, TerrainError> {
        let of_object = |statement: &&Statement| match statement.objects.last() {
            None => object.is_empty(),
            Some(last) => last == object || (object.is_empty() && last.ends_with("FILE")),
        };
        let mut found = self.statements.iter().filter(of_object).filter(|statement| statement.key == key);
        let first = found.next();
        if found.any(|other| Some(&other.values) != first.map(|statement| &statement.values)) {
            return Err(unsuitable(format!("{key} more than once, with different values"), "one image in one label"));
        }
        Ok(first.map(|statement| statement.values.as_slice()))
    }

    /// The single value of a key.
    ///
    /// # Errors
    /// As [`Label::values`], and if there are several.
    pub(super) fn value(&self, object: &str, key: &str) -> Result<Option<&Value>, TerrainError> {
        match self.values(object, key)? {
            None => Ok(None),
            Some([only]) => Ok(Some(only)),
            Some(several) => Err(unsuitable(format!("{key} with {} values", several.len()), "a single one")),
        }
    }

    /// A finite number of an object.
    ///
    /// # Errors
    /// As [`Label::value`], and if it is not a finite number.
    pub(super) fn number(&self, object: &str, key: &str) -> Result<Option<f64>, TerrainError> {
        let Some(value) = self.value(object, key)? else { return Ok(None) };
        match value.text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(unsuitable(format!("{key} {}", shown(&value.text)), "a finite number")),
        }
    }

    /// A non-negative integer of an object.
    ///
    /// # Errors
    /// As [`Label::value`], and if it is not an integer.
    pub(super) fn count(&self, object: &str, key: &str) -> Result<Option<usize>, TerrainError> {
        let Some(value) = self.value(object, key)? else { return Ok(None) };
        let count = value.text.parse().map_err(|_| unsuitable(format!("{key} {}", shown(&value.text)), "a whole number"))?;
        Ok(Some(count))
    }
}

/// Whether a file begins like a label: with its version, after comments and an envelope.
pub(super) fn begins_label(beginning: &[u8]) -> bool {
    let mut reader = Reader { bytes: beginning, at: 0, line: 1 };
    reader.skip_envelope();
    reader.skip_space();
    let key = reader.word();
    ["PDS_VERSION_ID", "ODL_VERSION_ID"].iter().any(|version| key.eq_ignore_ascii_case(version)) && reader.equals()
}

/// The error for a valid label without usable elevations.
pub(super) fn unsuitable(found: impl AsRef<str>, expected: &'static str) -> TerrainError {
    let found = found.as_ref();
    TerrainError::Unsuitable {
        found: format!("a PDS3 label with {found}"),
        expected,
        mend: "correct a copy of the label, or gdal_translate label.lbl out.tif if GDAL reads it correctly".to_owned(),
    }
}

/// The beginning of a text, in printable characters and quotes.
pub(super) fn shown(text: &str) -> String {
    format!("'{}'", crate::quantity::excerpt(text, 40))
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl Reader<'_> {
    fn damaged(&self, reason: &str) -> TerrainError {
        TerrainError::Damaged { format: "PDS3 label", reason: format!("line {}: {reason}", self.line) }
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn step(&mut self) {
        let next = self.bytes.get(self.at + 1);
        if self.peek() == Some(b'\n') || (self.peek() == Some(b'\r') && next != Some(&b'\n')) {
            self.line += 1;
        }
        self.at += 1;
    }

    /// Old labels begin with a line of their own format ("CCSD3ZF...").
    fn skip_envelope(&mut self) {
        if self.bytes.starts_with(b"\xef\xbb\xbf") {
            self.at += 3;
        }
        if self.bytes[self.at..].get(..4).is_some_and(|start| start.eq_ignore_ascii_case(b"CCSD")) {
            while self.peek().is_some_and(|byte| !matches!(byte, b'\n' | b'\r')) {
                self.step();
            }
        }
    }

    /// Skips white space and comments.
    fn skip_space(&mut self) {
        loop {
            while self.peek().is_some_and(|byte| byte.is_ascii_whitespace() || byte == 0) {
                self.step();
            }
            if !self.bytes[self.at.min(self.bytes.len())..].starts_with(b"/*") {
                return;
            }
            while self.at < self.bytes.len() && !self.bytes[self.at..].starts_with(b"*/") {
                self.step();
            }
            self.at = (self.at + 2).min(self.bytes.len());
        }
    }

    fn word(&mut self) -> String {
        let start = self.at;
        while self.peek().is_some_and(|byte| !byte.is_ascii_whitespace() && !b"=,(){}<>\"\0".contains(&byte)) {
            self.step();
        }
        String::from_utf8_lossy(&self.bytes[start..self.at]).into_owned()
    }

    fn equals(&mut self) -> bool {
        self.skip_space();
        let there = self.peek() == Some(b'=');
        if there {
            self.step();
            self.skip_space();
        }
        there
    }

    /// One value, or all of a sequence or set.
    fn values(&mut self) -> Result<Vec<Value>, TerrainError> {
        let mut values = Vec::new();
        let mut depth = 0;
        loop {
            self.skip_space();
            match self.peek() {
                None => return Err(self.damaged("the text ends within a value")),
                Some(b'(' | b'{') => {
                    depth += 1;
                    if depth > DEEPEST {
                        return Err(self.damaged("parentheses nested too deeply"));
                    }
                    self.step();
                }
                Some(b')' | b'}') if depth > 0 => {
                    depth -= 1;
                    self.step();
                }
                Some(b',') if depth > 0 => self.step(),
                Some(_) => values.push(self.scalar()?),
            }
            if depth == 0 {
                return Ok(values);
            }
        }
    }

    fn scalar(&mut self) -> Result<Value, TerrainError> {
        let text = if let Some(quote @ (b'"' | b'\'')) = self.peek() {
            self.enclosed(quote)?
        } else {
            let word = self.word();
            // Nothing was read: without an error the same place would be read for ever.
            if word.is_empty() {
                return Err(self.damaged("no value after '='"));
            }
            word
        };
        while matches!(self.peek(), Some(b' ' | b'\t')) {
            self.step();
        }
        let unit = if self.peek() == Some(b'<') { Some(self.enclosed(b'>')?.to_ascii_uppercase()) } else { None };
        Ok(Value { text, unit })
    }

    /// The text from the current byte to the next `end`, both excluded.
    fn enclosed(&mut self, end: u8) -> Result<String, TerrainError> {
        self.step();
        let start = self.at;
        while self.peek().is_some_and(|byte| byte != end) {
            self.step();
        }
        if self.peek().is_none() {
            return Err(self.damaged(&format!("the text ends before a closing {}", char::from(end))));
        }
        let text = String::from_utf8_lossy(&self.bytes[start..self.at]).trim().to_owned();
        self.step();
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "CCSD3ZF0000100000001NJPL3IF0PDSX00000001\r\nPDS_VERSION_ID = PDS3 /* a comment\n = */\n^IMAGE = (\"A.IMG\", 3 <BYTES>)\n\
                        NOTE = \"two\n lines = here\"\nOBJECT = IMAGE\n LINES = 12\n SPOTS = {1, 2}\n END_OBJECT = IMAGE\n\
                        OBJECT = IMAGE_MAP_PROJECTION\nMAP_SCALE = 0.5<km/pixel>\nEND_OBJECT\nEND\nrubbish";

    #[test]
    fn statements_are_found_by_object_and_key() {
        let label = Label::parse(TEXT.as_bytes()).unwrap();
        assert_eq!(label.value("", "PDS_VERSION_ID").unwrap().unwrap().text, "PDS3");
        let pointer = label.values("", "^IMAGE").unwrap().unwrap();
        assert_eq!((pointer[0].text.as_str(), pointer[1].text.as_str()), ("A.IMG", "3"));
        assert_eq!(pointer[1].unit.as_deref(), Some("BYTES"));
        assert_eq!(label.count("IMAGE", "LINES").unwrap(), Some(12));
        assert_eq!(label.count("IMAGE", "LINE_SAMPLES").unwrap(), None);
        assert_eq!(label.value("IMAGE_MAP_PROJECTION", "MAP_SCALE").unwrap().unwrap().unit.as_deref(), Some("KM/PIXEL"));
        assert!(label.value("IMAGE", "SPOTS").unwrap_err().to_string().contains("2 values"));
        assert!(label.has("IMAGE") && !label.has("TABLE"));
        assert_eq!(label.value("", "NOTE").unwrap().unwrap().text, "two\n lines = here");
    }

    #[test]
    fn texts_that_are_not_labels_are_refused_with_the_line() {
        for (text, expected) in [
            ("A = 1\nB\nC = 2\nEND", "line 3"),
            ("A = 1\n", "no END"),
            ("A = \"open", "closing"),
            ("A = (1, 2", "within a value"),
            ("A = 5 <M", "closing >"),
            ("END_OBJECT = X\nEND", "without an open object"),
            ("A = ,\nEND", "no value"),
            ("A = (\"b\"=\nEND", "no value"),
            ("A = ('b'>, 2)\nEND", "no value"),
            ("A = \"b\" = 2\nEND", "no further statement"),
        ] {
            let message = Label::parse(text.as_bytes()).unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
        let deep = "OBJECT = A\n".repeat(40);
        assert!(Label::parse(deep.as_bytes()).unwrap_err().to_string().contains("nested too deeply"));
        assert!(Label::parse(format!("A = {}", "(".repeat(40)).as_bytes()).is_err());
    }

    #[test]
    fn two_images_in_one_label_are_refused() {
        let text = "OBJECT = IMAGE\nLINES = 2\nEND_OBJECT\nOBJECT = IMAGE\nLINES = 3\nEND_OBJECT\nEND";
        let label = Label::parse(text.as_bytes()).unwrap();
        assert!(label.count("IMAGE", "LINES").unwrap_err().to_string().contains("more than once"));
    }
}
