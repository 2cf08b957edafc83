//! A table: columns with units, rows of cells, notes; as plain text for a terminal.

use super::number;

/// Where the cells of a column stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Words.
    Left,
    /// Numbers.
    Right,
    /// Marks.
    Centre,
}

/// The head of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// What it holds: "ω".
    pub name: String,
    /// Its unit: "rad/s"; empty for none.
    pub unit: String,
    /// Where its cells stand.
    pub align: Align,
}

impl Column {
    /// A column of numbers in a unit (empty for none).
    pub fn number(name: &str, unit: &str) -> Self {
        Self { name: name.into(), unit: unit.into(), align: Align::Right }
    }

    /// A column of words.
    pub fn text(name: &str) -> Self {
        Self { name: name.into(), unit: String::new(), align: Align::Left }
    }

    /// A column of marks.
    pub fn mark(name: &str) -> Self {
        Self { name: name.into(), unit: String::new(), align: Align::Centre }
    }
}

/// One cell: its text is made when it is made, by the functions of [`number`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cell(pub String);

impl Cell {
    /// A number with so many significant digits.
    pub fn significant(value: f64, digits: usize) -> Self {
        Self(number::significant(value, digits))
    }

    /// A number with so many decimals.
    pub fn decimals(value: f64, places: usize) -> Self {
        Self(number::decimals(value, places))
    }

    /// A ratio in per cent with one decimal and its sign.
    pub fn percent(ratio: f64) -> Self {
        Self(number::percent(ratio, 1))
    }

    /// A mark where `on`, else nothing.
    pub fn mark(on: bool) -> Self {
        Self(if on { "●" } else { "" }.into())
    }

    /// Nothing.
    pub fn empty() -> Self {
        Self::default()
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self(text.into())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self(text)
    }
}

impl From<u64> for Cell {
    fn from(value: u64) -> Self {
        Self(number::count(value))
    }
}

/// A table a person likes to read. Rows shorter than `columns` are filled with empty cells; surplus
/// cells are not shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// Heads.
    pub columns: Vec<Column>,
    /// Cells by row.
    pub rows: Vec<Vec<Cell>>,
    /// Sentences below it.
    pub notes: Vec<String>,
}

impl Table {
    /// A table without rows and notes.
    pub fn new(title: &str, columns: Vec<Column>) -> Self {
        Self { title: title.into(), columns, rows: Vec::new(), notes: Vec::new() }
    }

    /// Plain text: title, head and a light rule (unless no column has a name), rows, notes; each line ends with a line feed and has
    /// no trailing blanks.
    pub fn text(&self) -> String {
        let mut text = String::new();
        if !self.title.is_empty() {
            text += &format!("{}\n", self.title);
        }
        if !self.columns.is_empty() {
            let widths = self.widths();
            let line = |cells: Vec<&str>| {
                let padded = cells.iter().zip(&self.columns).zip(&widths).map(|((t, c), &w)| pad(t, c.align, w));
                format!("{}\n", format!("  {}", padded.collect::<Vec<_>>().join("  ")).trim_end())
            };
            if self.columns.iter().any(|c| !c.name.is_empty()) {
                text += &line(self.columns.iter().map(|c| c.name.as_str()).collect());
                if self.has_units() {
                    text += &line(self.columns.iter().map(|c| c.unit.as_str()).collect());
                }
                let width = widths.iter().sum::<usize>() + 2 * (widths.len() - 1);
                text += &format!("  {}\n", "─".repeat(width));
            }
            for row in &self.rows {
                text += &line(self.cells(row).collect());
            }
        }
        for note in &self.notes {
            text += &format!("  {note}\n");
        }
        text
    }

    /// True when a column has a unit.
    pub(super) fn has_units(&self) -> bool {
        self.columns.iter().any(|c| !c.unit.is_empty())
    }

    /// One text per column.
    pub(super) fn cells<'a>(&'a self, row: &'a [Cell]) -> impl Iterator<Item = &'a str> {
        (0..self.columns.len()).map(|k| row.get(k).map_or("", |c| c.0.as_str()))
    }

    fn widths(&self) -> Vec<usize> {
        let mut widths: Vec<usize> = self.columns.iter().map(|c| width(&c.name).max(width(&c.unit))).collect();
        for row in &self.rows {
            for (w, cell) in widths.iter_mut().zip(self.cells(row)) {
                *w = (*w).max(width(cell));
            }
        }
        widths
    }
}

fn width(text: &str) -> usize {
    text.chars().count()
}

fn pad(text: &str, align: Align, to: usize) -> String {
    let free = to.saturating_sub(width(text));
    let left = match align {
        Align::Left => 0,
        Align::Right => free,
        Align::Centre => free / 2,
    };
    format!("{}{text}{}", " ".repeat(left), " ".repeat(free - left))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_lines_up() {
        let mut t =
            Table::new("Modes", vec![Column::number("mode", ""), Column::number("ω", "rad/s"), Column::text("origin")]);
        t.rows.push(vec!["7".into(), Cell::decimals(107.0708, 3), "computed".into()]);
        t.rows.push(vec!["11".into(), Cell::decimals(1272.074, 3)]);
        t.notes.push("damping 0.03 (assumed)".into());
        let expected = "\
Modes
  mode         ω  origin
           rad/s
  ────────────────────────
     7   107.071  computed
    11  1272.074
  damping 0.03 (assumed)
";
        assert_eq!(t.text(), expected);
    }

    #[test]
    fn odd_rows_and_no_columns_are_survived() {
        let mut t = Table::new("", vec![Column::mark("kept")]);
        t.rows = vec![vec![], vec![Cell::mark(true), "surplus".into()]];
        assert_eq!(t.text(), "  kept\n  ────\n\n   ●\n");
        assert_eq!(Table::new("t", vec![]).text(), "t\n");
    }
}
