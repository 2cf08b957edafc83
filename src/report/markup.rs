//! Tables as Markdown and as HTML; escaping of text for both.

use super::table::{Align, Table};

/// Text safe inside HTML elements and quoted attributes. Characters that HTML forbids become "�".
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            '\n' | '\t' => safe.push(c),
            c if c.is_control() => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// A cell of a Markdown table: no line breaks, no column separators, no markup, no HTML.
fn markdown_cell(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\r' => safe.push(' '),
            '|' | '\\' | '*' | '_' | '`' | '[' | ']' => {
                safe.push('\\');
                safe.push(c);
            }
            '<' => safe += "&lt;",
            '&' => safe += "&amp;",
            c => safe.push(c),
        }
    }
    safe
}

impl Table {
    /// GitHub-flavoured Markdown: title in bold, units behind the names, notes as a paragraph.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        if !self.title.is_empty() {
            text += &format!("**{}**\n\n", markdown_cell(&self.title));
        }
        if !self.columns.is_empty() {
            let head = self.columns.iter().map(|c| {
                let unit = if c.unit.is_empty() { String::new() } else { format!(" ({})", markdown_cell(&c.unit)) };
                markdown_cell(&c.name) + &unit
            });
            text += &format!("| {} |\n", head.collect::<Vec<_>>().join(" | "));
            let rule = self.columns.iter().map(|c| match c.align {
                Align::Left => ":---",
                Align::Right => "---:",
                Align::Centre => ":---:",
            });
            text += &format!("| {} |\n", rule.collect::<Vec<_>>().join(" | "));
            for row in &self.rows {
                text += &format!("| {} |\n", self.cells(row).map(markdown_cell).collect::<Vec<_>>().join(" | "));
            }
        }
        if !self.notes.is_empty() {
            text += &format!("\n{}\n", self.notes.iter().map(|n| markdown_cell(n)).collect::<Vec<_>>().join("  \n"));
        }
        text
    }

    /// An HTML `<figure class="table">` with title, head, units, rows and notes; all text escaped.
    pub fn html(&self) -> String {
        let mut html = String::from("<figure class=\"table\">\n");
        if !self.title.is_empty() {
            html += &format!("<figcaption>{}</figcaption>\n", escape(&self.title));
        }
        if !self.columns.is_empty() {
            html += "<div class=\"scroll\"><table>\n<thead><tr>";
            for c in &self.columns {
                let unit =
                    if self.has_units() { format!("<br><small>{}</small>", escape(&c.unit)) } else { String::new() };
                html += &format!("<th scope=\"col\"{}>{}{unit}</th>", class(c.align), escape(&c.name));
            }
            html += "</tr></thead>\n<tbody>\n";
            for row in &self.rows {
                html += "<tr>";
                for (cell, c) in self.cells(row).zip(&self.columns) {
                    html += &format!("<td{}>{}</td>", class(c.align), escape(cell));
                }
                html += "</tr>\n";
            }
            html += "</tbody></table></div>\n";
        }
        for note in &self.notes {
            html += &format!("<p class=\"note\">{}</p>\n", escape(note));
        }
        html + "</figure>\n"
    }
}

fn class(align: Align) -> &'static str {
    match align {
        Align::Left => "",
        Align::Right => " class=\"right\"",
        Align::Centre => " class=\"centre\"",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::table::{Cell, Column};

    fn table() -> Table {
        let mut t = Table::new("a<b", vec![Column::text("name|x"), Column::number("f", "N/m")]);
        t.rows.push(vec!["<script>\n".into(), Cell::significant(1.5, 2)]);
        t.notes.push("a_b & c".into());
        t
    }

    #[test]
    fn markdown_keeps_its_columns() {
        let expected =
            "**a&lt;b**\n\n| name\\|x | f (N/m) |\n| :--- | ---: |\n| &lt;script>  | 1.5 |\n\na\\_b &amp; c\n";
        assert_eq!(table().markdown(), expected);
    }

    #[test]
    fn html_is_escaped() {
        let html = table().html();
        assert!(html.contains("a&lt;b") && html.contains("<td>&lt;script&gt;\n</td>"));
        assert!(html.contains("<td class=\"right\">1.5</td>") && html.contains("a_b &amp; c"));
        assert!(!html.contains("<script"));
        assert_eq!(escape("\"'\u{0}"), "&quot;&#39;\u{fffd}");
    }
}
