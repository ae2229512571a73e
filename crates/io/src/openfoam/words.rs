//! OpenFOAM's text: words, strings, punctuation and comments, out of bytes that may hold binary lists too.

/// What stands next in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token<'a> {
    /// A keyword, a number, or a macro with its `$` or `#`.
    Word(&'a [u8]),
    /// What stands between quotation marks.
    Quoted(&'a [u8]),
    /// One of `( ) { } [ ] ;`.
    Mark(u8),
}

/// Something wrong at a byte.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Bad {
    /// Where.
    pub(super) at: usize,
    /// What.
    pub(super) problem: String,
}

/// A place in a file's bytes, which only moves forward.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) at: usize,
}

/// Longest part of a file that a message repeats, in bytes.
const SHOWN: usize = 40;

impl<'a> Words<'a> {
    /// From a byte on.
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at: at.min(bytes.len()) }
    }

    /// What was not read yet.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// Moves to the next byte that is neither white space nor in a comment, and gives it.
    pub(super) fn peek(&mut self) -> Option<u8> {
        loop {
            let rest = self.rest();
            let &byte = rest.first()?;
            if byte.is_ascii_whitespace() {
                self.at += 1;
            } else if rest.starts_with(b"//") {
                self.at += rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
            } else if rest.starts_with(b"/*") {
                let end = rest.get(2..).unwrap_or_default().windows(2).position(|pair| pair == b"*/");
                self.at += end.map_or(rest.len(), |end| end + 4);
            } else {
                return Some(byte);
            }
        }
    }

    /// The next token; nothing at the end.
    pub(super) fn next(&mut self) -> Option<Token<'a>> {
        let first = self.peek()?;
        let rest = self.rest();
        if is_mark(first) {
            self.at += 1;
            return Some(Token::Mark(first));
        }
        if first == b'"' {
            let inside = rest.get(1..).unwrap_or_default();
            let length = closing_quote(inside);
            self.at += (length + 2).min(rest.len());
            return Some(Token::Quoted(inside.get(..length).unwrap_or_default()));
        }
        let ends = |i: usize, b: u8| {
            b.is_ascii_whitespace()
                || is_mark(b)
                || b == b'"'
                || (b == b'/' && matches!(rest.get(i + 1), Some(b'/' | b'*')))
        };
        let length = rest.iter().enumerate().position(|(i, &b)| ends(i, b)).unwrap_or(rest.len()).max(1);
        self.at += length;
        Some(Token::Word(rest.get(..length).unwrap_or_default()))
    }

    /// The next token if it is this mark.
    pub(super) fn take_mark(&mut self, mark: u8) -> bool {
        let found = self.peek() == Some(mark);
        self.at += usize::from(found);
        found
    }

    /// Passes a mark that has to be there.
    pub(super) fn expect(&mut self, mark: u8) -> Result<(), Bad> {
        if self.take_mark(mark) { Ok(()) } else { Err(self.bad_next(&format!("`{}`", char::from(mark)))) }
    }

    /// A number that is the next word.
    pub(super) fn number<T: std::str::FromStr>(&mut self, what: &str) -> Result<T, Bad> {
        let before = *self;
        let number = match self.next() {
            Some(Token::Word(word)) => std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()),
            _ => None,
        };
        number.ok_or_else(|| {
            *self = before;
            self.bad_next(what)
        })
    }

    /// Passes what belongs to an entry behind its keyword: all to its `;`, or a block in braces.
    pub(super) fn skip_entry(&mut self) {
        let mut depth = 0_usize;
        while let Some(token) = self.next() {
            match token {
                Token::Mark(b'{' | b'(' | b'[') => depth += 1,
                Token::Mark(b'}' | b')' | b']') => {
                    depth = depth.saturating_sub(1);
                    if depth == 0 && token == Token::Mark(b'}') {
                        return;
                    }
                }
                Token::Mark(b';') if depth == 0 => return,
                _ => {}
            }
        }
    }

    /// Passes the rest of a line.
    pub(super) fn skip_line(&mut self) {
        let rest = self.rest();
        self.at += rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
    }

    /// That something else was expected next.
    pub(super) fn bad_next(&mut self, expected: &str) -> Bad {
        let found = match self.peek() {
            None => "the file ends".to_owned(),
            Some(_) => {
                let rest = self.rest();
                let line = rest.split(|&b| b == b'\n').next().unwrap_or_default();
                format!("there is `{}`", show(line))
            }
        };
        Bad { at: self.at, problem: format!("{found} where {expected} is expected") }
    }
}

/// Words of a file as they are shown.
pub(super) fn show(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes.get(..SHOWN).unwrap_or(bytes)).into_owned()
}

fn is_mark(byte: u8) -> bool {
    matches!(byte, b'(' | b')' | b'{' | b'}' | b'[' | b']' | b';')
}

/// How many bytes stand before the closing quotation mark; one behind a backslash does not close.
fn closing_quote(inside: &[u8]) -> usize {
    let mut at = 0;
    while let Some(&byte) = inside.get(at) {
        match byte {
            b'"' => return at,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    inside.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_and_comments() {
        let text = b"/* a { */ FoamFile{a \"x;\\\"y\";}// end\n3(1 2/*x*/-4e1)$p #include";
        let mut words = Words::new(text, 0);
        let mut all = Vec::new();
        while let Some(token) = words.next() {
            all.push(match token {
                Token::Word(w) => show(w),
                Token::Quoted(w) => format!("'{}'", show(w)),
                Token::Mark(m) => char::from(m).to_string(),
            });
        }
        let expected = ["FoamFile", "{", "a", "'x;\\\"y'", ";", "}", "3", "(", "1", "2", "-4e1", ")", "$p", "#include"];
        assert_eq!(all, expected);
    }

    #[test]
    fn what_does_not_close_ends_with_the_file() {
        for text in [&b"/* x"[..], b"//", b"\"x", b"\"x\\", b"/", b"/*/"] {
            let mut words = Words::new(text, 0);
            while words.next().is_some() {}
            assert!(words.rest().is_empty(), "{text:?}");
        }
        let mut words = Words::new(b"a { b ( c } d;", 0);
        words.skip_entry();
        assert_eq!(words.next(), None);
    }

    #[test]
    fn entries_are_passed() {
        let mut words = Words::new(b"1 (2;) [0 1]; {a {b;} c;} x", 0);
        words.skip_entry();
        words.skip_entry();
        assert_eq!(words.next(), Some(Token::Word(b"x")));
    }

    #[test]
    fn wrong_numbers_are_shown() {
        let mut words = Words::new(b"  x1\ny", 0);
        let bad = words.number::<usize>("a count").unwrap_err();
        assert_eq!(bad, Bad { at: 2, problem: "there is `x1` where a count is expected".to_owned() });
        assert!(Words::new(b"", 0).number::<f64>("it").unwrap_err().problem.contains("the file ends"));
    }
}
