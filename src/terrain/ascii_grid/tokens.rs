//! Reads the words of a text one by one with their positions, from any source and for lines of any length.

use std::io::{self, BufRead};

/// The longest word kept; keys and numbers are shorter. A longer word is truncated and reported, so that a file of one
/// endless word needs little memory.
const LONGEST_WORD: usize = 512;

/// A word and its position.
#[derive(Clone, Debug, Default)]
pub(super) struct Token {
    pub(super) text: String,
    pub(super) line: usize,
    pub(super) column: usize,
}

/// What begins a comment, which reaches to the end of its line.
const COMMENTS: [&[u8]; 5] = [b"#", b"//", b"%", b"!", b";"];

/// Whether a word begins a comment.
pub(super) fn begins_comment(word: &[u8]) -> bool {
    COMMENTS.iter().any(|sign| word.starts_with(sign))
}

/// Reads words separated by white space. Lines end with a line feed, a carriage return, or both.
pub(super) struct Tokens<R> {
    source: R,
    line: usize,
    column: usize,
    /// Whether the last byte was a carriage return, whose line feed begins no further line.
    after_return: bool,
    word: Vec<u8>,
    peeked: Option<Token>,
}

impl<R: BufRead> Tokens<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source, line: 1, column: 1, after_return: false, word: Vec::new(), peeked: None }
    }

    /// The next word without consuming it.
    pub(super) fn peek(&mut self) -> io::Result<Option<&Token>> {
        if self.peeked.is_none() {
            self.peeked = self.read_word()?;
        }
        Ok(self.peeked.as_ref())
    }

    /// The next word; `None` at the end.
    pub(super) fn next(&mut self) -> io::Result<Option<Token>> {
        match self.peeked.take() {
            Some(token) => Ok(Some(token)),
            None => self.read_word(),
        }
    }

    /// The current position: line and column.
    pub(super) fn place(&self) -> (usize, usize) {
        (self.line, self.column)
    }

    fn read_word(&mut self) -> io::Result<Option<Token>> {
        loop {
            let token = self.read_any_word()?;
            if !begins_comment(&self.word) {
                return Ok(token);
            }
            self.skip_line()?;
        }
    }

    fn skip_line(&mut self) -> io::Result<()> {
        loop {
            let buffer = self.source.fill_buf()?;
            let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let used = end.unwrap_or(buffer.len());
            let ended = end.is_some() || buffer.is_empty();
            self.source.consume(used);
            self.column += used;
            if ended {
                return Ok(());
            }
        }
    }

    fn read_any_word(&mut self) -> io::Result<Option<Token>> {
        self.word.clear();
        let (mut line, mut column) = (0, 0);
        loop {
            let buffer = self.source.fill_buf()?;
            if buffer.is_empty() {
                break;
            }
            let mut used = 0;
            let mut ended = false;
            for &byte in buffer {
                if byte.is_ascii_whitespace() || byte == 0x0b {
                    if !self.word.is_empty() {
                        ended = true;
                        break;
                    }
                } else {
                    if self.word.is_empty() {
                        (line, column) = (self.line, self.column);
                    }
                    if self.word.len() < LONGEST_WORD {
                        self.word.push(byte);
                    }
                }
                used += 1;
                match byte {
                    b'\n' if self.after_return => {}
                    b'\n' | b'\r' => {
                        self.line += 1;
                        self.column = 1;
                    }
                    _ => self.column += 1,
                }
                self.after_return = byte == b'\r';
            }
            self.source.consume(used);
            if ended {
                break;
            }
        }
        if self.word.is_empty() {
            return Ok(None);
        }
        Ok(Some(Token { text: String::from_utf8_lossy(&self.word).into_owned(), line, column }))
    }
}
