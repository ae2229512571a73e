//! Names of data files that differ in a number: `slice.%03d 1 93 1`.

/// A pattern and its numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pattern {
    before: String,
    after: String,
    /// What fills a number up from the left: nothing where it is filled up with blanks from the right.
    fill: Option<char>,
    plus: bool,
    width: usize,
    first: i64,
    last: i64,
    step: i64,
    /// What stands behind the numbers: how many axes a file has.
    pub(super) dimension: Option<String>,
}

/// Longest number in a name, in characters; file systems have names of 255 bytes.
const MOST_WIDTH: usize = 200;

impl Pattern {
    /// Whether a word has a number in it as `printf` of C would write it.
    pub(super) fn is_one(word: &str) -> bool {
        let mut rest = word;
        while let Some((_, behind)) = rest.split_once('%') {
            rest = match behind.strip_prefix('%') {
                Some(behind) => behind,
                None => {
                    return behind
                        .trim_start_matches(|c: char| "0123456789-+ ".contains(c))
                        .starts_with(['d', 'i', 'u']);
                }
            };
        }
        false
    }

    /// From `pattern first last step [axes]`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let mut words = text.split_whitespace();
        let word = words.next().unwrap_or_default();
        let mut number = |name: &str| {
            let word = words.next().ok_or_else(|| format!("behind the pattern of names stands no {name} number"))?;
            word.parse::<i64>().map_err(|_| format!("`{word}` is no {name} number for the pattern of names"))
        };
        let (first, last, step) = (number("first")?, number("last")?, number("step")?);
        let dimension = words.next().map(str::to_owned);

        let wrong = || format!("`{word}` is no pattern with one number, as in slice.%03d");
        let at = conversion(word).ok_or_else(wrong)?;
        let (before, rest) = word.split_at_checked(at).ok_or_else(wrong)?;
        let rest = rest.strip_prefix('%').ok_or_else(wrong)?;
        let flags_end = rest.find(|c: char| !"0-+".contains(c)).ok_or_else(wrong)?;
        let (flags, rest) = rest.split_at_checked(flags_end).ok_or_else(wrong)?;
        let width_end = rest.find(|c: char| !c.is_ascii_digit()).ok_or_else(wrong)?;
        let (width, rest) = rest.split_at_checked(width_end).ok_or_else(wrong)?;
        let after = rest.strip_prefix(['d', 'i', 'u']).ok_or_else(wrong)?;
        if conversion(after).is_some() {
            return Err(wrong());
        }
        let width = if width.is_empty() { 0 } else { width.parse().unwrap_or(usize::MAX) };
        if width > MOST_WIDTH {
            return Err(format!("`{word}` asks for numbers of more than {MOST_WIDTH} characters"));
        }
        let fill = match (flags.contains('-'), flags.contains('0')) {
            (true, _) => None,
            (false, true) => Some('0'),
            (false, false) => Some(' '),
        };
        let unescaped = |text: &str| text.replace("%%", "%");
        let (before, after) = (unescaped(before), unescaped(after));
        Ok(Self { before, after, fill, plus: flags.contains('+'), width, first, last, step, dimension })
    }

    /// How many names there are; 0 where the step leads away from the last one, or nowhere.
    pub(super) fn count(&self) -> usize {
        let way = i128::from(self.last) - i128::from(self.first);
        match way.checked_div(self.step.into()) {
            Some(_) if way != 0 && (way < 0) != (self.step < 0) => 0,
            Some(steps) => usize::try_from(steps).map_or(usize::MAX, |steps| steps.saturating_add(1)),
            None => 0,
        }
    }

    /// All names, from the first number to the last.
    pub(super) fn names(self) -> impl Iterator<Item = String> {
        (0..self.count()).map(move |index| self.name(index))
    }

    fn name(&self, index: usize) -> String {
        let number = i128::from(self.first) + i128::from(self.step) * index as i128;
        let sign = if number < 0 {
            "-"
        } else if self.plus {
            "+"
        } else {
            ""
        };
        let digits = number.unsigned_abs().to_string();
        let missing = self.width.saturating_sub(sign.len() + digits.len());
        let Self { before, after, .. } = self;
        match self.fill {
            Some('0') => format!("{before}{sign}{}{digits}{after}", "0".repeat(missing)),
            Some(_) => format!("{before}{}{sign}{digits}{after}", " ".repeat(missing)),
            None => format!("{before}{sign}{digits}{}{after}", " ".repeat(missing)),
        }
    }
}

/// Where the first per cent sign stands that is not one of a pair.
fn conversion(text: &str) -> Option<usize> {
    let mut from = 0;
    loop {
        let at = from + text.get(from..)?.find('%')?;
        if !text.get(at + 1..)?.starts_with('%') {
            return Some(at);
        }
        from = at + 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        Pattern::parse(text).unwrap_or_else(|error| panic!("{error}")).names().collect()
    }

    #[test]
    fn names_as_printf_writes_them() {
        assert_eq!(names("quarter.%d 1 3 1"), ["quarter.1", "quarter.2", "quarter.3"]);
        assert_eq!(names("s%03d.raw 9 11 2"), ["s009.raw", "s011.raw"]);
        assert_eq!(names("%%%+04ia 1 -1 -1"), ["%+001a", "%+000a", "%-001a"]);
        assert_eq!(names("%3u.x 5 5 -1"), ["  5.x"]);
        assert_eq!(names("%-3d.x 5 6 7"), ["5  .x"]);
        assert_eq!(Pattern::parse("a%d 1 2 1 3").unwrap().dimension.as_deref(), Some("3"));
        assert!(
            Pattern::is_one("a%%%02d.x")
                && !Pattern::is_one("a%%d.x")
                && !Pattern::is_one("50%")
                && !Pattern::is_one("%s")
        );
    }

    #[test]
    fn patterns_that_are_none() {
        for text in ["a%d", "a%d 1 2", "a%d 1 2 x", "a%d%d 1 2 1", "a%999d 1 2 1", "a%99999999999999999999d 1 2 1"] {
            assert!(Pattern::parse(text).is_err(), "{text}");
        }
        for text in ["a%d 1 2 -1", "a%d 1 2 0", "a%d 1 1 0"] {
            assert_eq!(names(text).len(), 0, "{text}");
        }
        let most = format!("a%d {} {} 1", i64::MIN, i64::MAX);
        assert_eq!(Pattern::parse(&most).unwrap().count(), usize::MAX);
        assert_eq!(Pattern::parse("a%d 1 2 -1").unwrap().count(), 0);
    }
}
