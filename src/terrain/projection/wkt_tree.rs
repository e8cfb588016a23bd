//! The grammar of well-known text: keywords with bracketed values, as in WKT 1 (OGC 01-009), its dialects, and WKT 2 (ISO 19162).

use super::crs_error::CrsError;

/// No text of a coordinate reference system is nested deeper (GDAL writes up to 8).
const DEEPEST: usize = 32;

/// A keyword and its values: `SPHEROID["Moon",1737400,0]`.
#[derive(Debug, PartialEq)]
pub(super) struct Node<'a> {
    pub(super) keyword: &'a str,
    pub(super) values: Vec<Value<'a>>,
}

/// One value in the brackets of a keyword.
#[derive(Debug, PartialEq)]
pub(super) enum Value<'a> {
    /// A text in quotation marks.
    Text(String),
    /// A finite number.
    Number(f64),
    /// A bare word, such as `EAST`.
    Word(&'a str),
    /// A keyword with values of its own.
    Node(Node<'a>),
}

impl<'a> Node<'a> {
    /// Reads a whole text.
    pub(super) fn parse(text: &'a str) -> Result<Self, CrsError> {
        let mut reader = Reader { text, rest: text };
        let keyword = reader.word();
        let root = reader.node(keyword, 0)?;
        match reader.next() {
            None => Ok(root),
            Some(_) => Err(reader.syntax("the end of the text")),
        }
    }

    /// Whether its keyword is one of these.
    pub(super) fn is(&self, keywords: &[&str]) -> bool {
        keywords.iter().any(|keyword| self.keyword.eq_ignore_ascii_case(keyword))
    }

    /// The nodes directly inside.
    pub(super) fn children(&self) -> impl Iterator<Item = &Self> {
        self.values.iter().filter_map(|value| match value {
            Value::Node(node) => Some(node),
            _ => None,
        })
    }

    /// The first node directly inside that has one of these keywords.
    pub(super) fn child(&self, keywords: &[&str]) -> Option<&Self> {
        self.children().find(|node| node.is(keywords))
    }

    /// The first node inside, at any depth, that has one of these keywords.
    pub(super) fn find(&self, keywords: &[&str]) -> Option<&Self> {
        self.children().find_map(|node| if node.is(keywords) { Some(node) } else { node.find(keywords) })
    }

    /// Its name: the first value, if that is a text.
    pub(super) fn name(&self) -> Option<&str> {
        match self.values.first()? {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The first bare word among its values.
    pub(super) fn word(&self) -> Option<&'a str> {
        self.values.iter().find_map(|value| match value {
            Value::Word(word) => Some(*word),
            _ => None,
        })
    }

    /// A value that is a number, counted from 0.
    pub(super) fn number(&self, index: usize) -> Option<f64> {
        match self.values.get(index)? {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }
}

struct Reader<'a> {
    text: &'a str,
    rest: &'a str,
}

impl<'a> Reader<'a> {
    /// The next letter that is not white space.
    fn next(&mut self) -> Option<char> {
        self.rest = self.rest.trim_start();
        self.rest.chars().next()
    }

    /// Goes past the next letter if it is one of these.
    fn take(&mut self, letters: &[char]) -> bool {
        self.next();
        let Some(rest) = self.rest.strip_prefix(letters) else { return false };
        self.rest = rest;
        true
    }

    /// What the rest begins with as long as its letters are of a kind.
    fn run(&mut self, of_kind: impl Fn(char) -> bool) -> &'a str {
        let end = self.rest.find(|letter| !of_kind(letter)).unwrap_or(self.rest.len());
        let (run, rest) = self.rest.split_at(end);
        self.rest = rest;
        run
    }

    fn word(&mut self) -> &'a str {
        self.next();
        self.run(|letter| letter.is_ascii_alphanumeric() || letter == '_')
    }

    fn syntax(&mut self, expected: &'static str) -> CrsError {
        let found = self.next().map_or_else(|| "its end".to_owned(), |letter| format!("'{}'", letter.escape_debug()));
        CrsError::Syntax { at: self.text.len() - self.rest.len(), found, expected }
    }

    fn node(&mut self, keyword: &'a str, depth: usize) -> Result<Node<'a>, CrsError> {
        if keyword.is_empty() {
            return Err(self.syntax("a keyword"));
        }
        if depth > DEEPEST {
            return Err(self.syntax("at most 32 brackets inside one another"));
        }
        if !self.take(&['[', '(']) {
            return Err(self.syntax("an opening bracket"));
        }
        let mut values = vec![self.value(depth)?];
        while self.take(&[',']) {
            values.push(self.value(depth)?);
        }
        if self.take(&[']', ')']) { Ok(Node { keyword, values }) } else { Err(self.syntax("a comma or a closing bracket")) }
    }

    fn value(&mut self, depth: usize) -> Result<Value<'a>, CrsError> {
        match self.next() {
            Some('"') => self.quoted().map(Value::Text),
            Some('0'..='9' | '+' | '-' | '.') => {
                let written = self.run(|letter| letter.is_ascii_alphanumeric() || matches!(letter, '+' | '-' | '.'));
                let number = written.parse().ok().filter(|number: &f64| number.is_finite());
                number.map(Value::Number).ok_or_else(|| CrsError::NotANumber {
                    item: "a value of the well-known text".to_owned(),
                    found: CrsError::excerpt(written),
                })
            }
            _ => {
                let word = self.word();
                if !word.is_empty() && !matches!(self.next(), Some('[' | '(')) {
                    return Ok(Value::Word(word));
                }
                self.node(word, depth + 1).map(Value::Node)
            }
        }
    }

    /// A text in quotation marks, where a doubled mark stands for one.
    fn quoted(&mut self) -> Result<String, CrsError> {
        let mut text = String::new();
        let mut rest = self.rest.strip_prefix('"').unwrap_or(self.rest);
        while let Some((before, after)) = rest.split_once('"') {
            text.push_str(before);
            let Some(more) = after.strip_prefix('"') else {
                self.rest = after;
                return Ok(text);
            };
            text.push('"');
            rest = more;
        }
        self.rest = "";
        Err(self.syntax("a closing quotation mark"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_of_brackets_doubled_quotes_and_white_space_are_read() {
        let root = Node::parse(" projcs ( \"a \"\"b\"\"\" ,\n EXTRA[ -1.5e3 , EAST ], UNIT[\"m\",1] ) ").unwrap();
        assert!(root.is(&["PROJCS"]));
        assert_eq!(root.name(), Some("a \"b\""));
        assert_eq!(root.child(&["Extra"]).and_then(|node| node.number(0)), Some(-1500.0));
        assert_eq!(root.find(&["UNIT"]).and_then(Node::name), Some("m"));
    }

    #[test]
    fn broken_text_is_refused_with_its_place() {
        let deep = "A[".repeat(100);
        for (text, word) in [
            ("PROJCS[\"a\"", "byte 10"),
            ("PROJCS[\"a]", "quotation mark"),
            ("PROJCS[\"a\"]]", "end of the text"),
            ("PROJCS", "opening bracket"),
            ("PROJCS[,]", "keyword"),
            ("", "keyword"),
            ("A[1.2.3]", "'1.2.3'"),
            ("A[1e999]", "'1e999'"),
            ("A[é]", "keyword"),
            (deep.as_str(), "at most 32"),
        ] {
            let message = Node::parse(text).unwrap_err().to_string();
            assert!(message.contains(word), "{text}: {message}");
        }
    }
}
