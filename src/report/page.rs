//! A project's report: one HTML page that needs no network, no script and no other file.

use super::markup::escape;
use super::plot::Picture;
use super::table::Table;
use crate::model::Source;

/// A picture with the sentence below it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figure {
    svg: String,
    caption: String,
}

impl Figure {
    /// Takes the vector form of a drawn picture.
    pub fn new(picture: &Picture, caption: &str) -> Self {
        Self { svg: picture.svg.clone(), caption: caption.to_owned() }
    }
}

/// A part of the page: heading, then paragraphs, pictures and tables in this order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Section {
    /// Heading.
    pub heading: String,
    /// Plain text, one paragraph each.
    pub paragraphs: Vec<String>,
    /// Tables.
    pub tables: Vec<Table>,
    /// Pictures.
    pub pictures: Vec<Figure>,
}

/// A page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Page {
    /// Title.
    pub title: String,
    /// What was found, in a few sentences; one paragraph each.
    pub lead: Vec<String>,
    /// Parts.
    pub sections: Vec<Section>,
    /// Files it rests on, listed with their hashes.
    pub sources: Vec<Source>,
    /// What made it: "ferrom 0.1.0".
    pub tool: String,
}

impl Page {
    /// The page as HTML; all text is escaped.
    pub fn html(&self) -> String {
        let title = escape(&self.title);
        let mut html = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n",
            include_str!("page.css")
        );
        for sentence in &self.lead {
            html += &format!("<p class=\"lead\">{}</p>\n", escape(sentence));
        }
        if self.sections.len() > 2 {
            html += &self.contents();
        }
        for (k, section) in self.sections.iter().enumerate() {
            html += &section.html(k + 1);
        }
        html + &self.provenance() + "</main>\n</body>\n</html>\n"
    }

    fn contents(&self) -> String {
        let link = |(k, s): (usize, &Section)| format!("<li><a href=\"#s{}\">{}</a></li>", k + 1, escape(&s.heading));
        let links: Vec<String> = self.sections.iter().enumerate().map(link).collect();
        format!("<nav><ol>{}</ol></nav>\n", links.join(""))
    }

    fn provenance(&self) -> String {
        if self.sources.is_empty() && self.tool.is_empty() {
            return String::new();
        }
        let mut html = String::from("<footer>\n<h2>Made from</h2>\n");
        if !self.sources.is_empty() {
            html += "<dl>\n";
            for s in &self.sources {
                html += &format!(
                    "<dt>{}: {}</dt><dd>SHA-256 <code>{}</code></dd>\n",
                    escape(&s.role),
                    escape(&s.path),
                    escape(&s.sha256)
                );
            }
            html += "</dl>\n";
        }
        if !self.tool.is_empty() {
            html += &format!("<p>by {}</p>\n", escape(&self.tool));
        }
        html + "</footer>\n"
    }
}

impl Section {
    fn html(&self, number: usize) -> String {
        let mut html = format!("<section id=\"s{number}\">\n<h2>{}</h2>\n", escape(&self.heading));
        for paragraph in &self.paragraphs {
            html += &format!("<p>{}</p>\n", escape(paragraph));
        }
        for figure in &self.pictures {
            html += &format!("<figure class=\"picture\">\n{}", figure.svg);
            if !figure.caption.is_empty() {
                html += &format!("<figcaption>{}</figcaption>\n", escape(&figure.caption));
            }
            html += "</figure>\n";
        }
        for table in &self.tables {
            html += &table.html();
        }
        html + "</section>\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::table::{Cell, Column};

    #[test]
    fn all_text_is_escaped_and_nothing_is_fetched() {
        let evil = "<script>alert('x')</script> & \"y\"".to_owned();
        let mut table = Table::new(&evil, vec![Column::text(&evil)]);
        table.rows.push(vec![Cell::from(evil.as_str())]);
        table.notes.push(evil.clone());
        let picture = Picture { svg: "<svg></svg>\n".into(), png: vec![] };
        let section = Section {
            heading: evil.clone(),
            paragraphs: vec![evil.clone()],
            tables: vec![table],
            pictures: vec![Figure::new(&picture, &evil)],
        };
        let source = Source { role: evil.clone(), path: evil.clone(), sha256: evil.clone() };
        let page = Page {
            title: evil.clone(),
            lead: vec![evil.clone()],
            sections: vec![section; 3],
            sources: vec![source],
            tool: evil,
        };
        let html = page.html();
        for forbidden in ["<script", "alert('", "http", "src=", "@import", "url("] {
            assert!(!html.contains(forbidden), "{forbidden}");
        }
        assert_eq!(html.matches("<svg>").count(), 3);
        assert!(html.contains("href=\"#s3\"") && html.contains("id=\"s3\""));
    }

    #[test]
    fn an_empty_page_is_a_page() {
        let html = Page::default().html();
        assert!(html.starts_with("<!DOCTYPE html>") && html.ends_with("</html>\n"));
        assert!(!html.contains("<footer"));
    }
}
