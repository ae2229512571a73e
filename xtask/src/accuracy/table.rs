//! Errors as a table in Markdown.

use std::fmt;

/// Errors for one optical model and one size of cells.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub(crate) title: String,
    /// Transfer functions.
    pub(crate) columns: Vec<&'static str>,
    pub(crate) rows: Vec<Row>,
}

/// A method with its table's size.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) method: &'static str,
    /// Empty where it has no table.
    pub(crate) size: String,
    /// One a column.
    pub(crate) cells: Vec<Cell>,
}

/// A method's error for one transfer function.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub(crate) largest: f64,
    pub(crate) root_mean_square: f64,
    pub(crate) mean: f64,
    /// Of one evaluation.
    pub(crate) nanoseconds: f64,
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "### {}\n", self.title)?;
        writeln!(f, "| Method | Size | {} | ns |", self.columns.join(" | "))?;
        writeln!(f, "| --- | --- |{} --- |", " --- |".repeat(self.columns.len()))?;
        for row in &self.rows {
            write!(f, "| `{}` | {} |", row.method, row.size)?;
            for cell in &row.cells {
                let errors = [cell.largest, cell.root_mean_square, cell.mean].map(rounded);
                write!(f, " {} |", errors.join(" / "))?;
            }
            let nanoseconds = row.cells.iter().map(|cell| cell.nanoseconds);
            let (least, most) = nanoseconds.fold((f64::INFINITY, 0.0_f64), |(l, m), ns| (l.min(ns), m.max(ns)));
            // The second digit is noise.
            let (least, most) = (two_digits(least), two_digits(most));
            if least == most { writeln!(f, " {least} |")? } else { writeln!(f, " {least} to {most} |")? }
        }
        Ok(())
    }
}

/// Two digits: `0.44`, `7.0e-4`; `0` below what rounding in f64 leaves.
fn rounded(error: f64) -> String {
    match error {
        error if error < 1e-13 => "0".to_owned(),
        error if error < 0.00995 => format!("{error:.1e}"),
        error => format!("{error:.2}"),
    }
}

fn two_digits(nanoseconds: f64) -> String {
    let unit = if nanoseconds >= 100.0 { 10f64.powf(nanoseconds.log10().floor() - 1.0) } else { 1.0 };
    format!("{:.0}", (nanoseconds / unit).round() * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [0.0, 1e-15, 7.04e-4, 0.0099, 0.44, 1.0].map(rounded),
            ["0", "0", "7.0e-4", "9.9e-3", "0.44", "1.00"]
        );
        assert_eq!([8.4, 99.6, 123.0, 4567.0].map(two_digits), ["8", "100", "120", "4600"]);
    }

    #[test]
    fn rows_have_as_many_columns_as_the_head() {
        let cell = Cell { largest: 0.5, root_mean_square: 0.1, mean: 1e-3, nanoseconds: 12.0 };
        let row = Row { method: "average", size: String::new(), cells: vec![cell; 2] };
        let table = Table { title: "t".to_owned(), columns: vec!["a", "b"], rows: vec![row] };
        let text = table.to_string();
        let bars: Vec<_> = text.lines().skip(2).map(|line| line.matches('|').count()).collect();
        assert_eq!(bars, [6, 6, 6]);
        assert!(text.contains("| `average` |  | 0.50 / 0.10 / 1.0e-3 | 0.50 / 0.10 / 1.0e-3 | 12 |"), "{text}");
    }
}
