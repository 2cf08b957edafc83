//! What a picture consists of once it is laid out, in SVG units from the top left corner.

use super::style::Colour;
use super::text;

/// A point of the picture.
pub(super) type Point = (f64, f64);

/// Where a text stands relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// It begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// One thing to paint.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// An open line.
    Line { points: Vec<Point>, colour: Colour, width: f64 },
    /// A filled polygon.
    Area { points: Vec<Point>, colour: Colour },
    /// A filled circle.
    Disc { centre: Point, radius: f64, colour: Colour },
    /// A line of text; `at` is on its baseline.
    Text { at: Point, text: String, em: f64, colour: Colour, anchor: Anchor },
}

impl Shape {
    /// A straight line.
    pub(super) fn segment(from: Point, to: Point, colour: Colour, width: f64) -> Self {
        Self::Line { points: vec![from, to], colour, width }
    }

    /// A filled rectangle.
    pub(super) fn rectangle(b: Box2, colour: Colour) -> Self {
        Self::Area { points: vec![(b.left, b.top), (b.right, b.top), (b.right, b.bottom), (b.left, b.bottom)], colour }
    }
}

/// A rectangle; `top` < `bottom`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Box2 {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Box2 {
    /// The rectangle of the given size around a point.
    pub(super) fn around((x, y): Point, width: f64, height: f64) -> Self {
        Self { left: x - width / 2.0, top: y - height / 2.0, right: x + width / 2.0, bottom: y + height / 2.0 }
    }

    /// Larger by `by` on each side.
    pub(super) fn grown(self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }

    /// True when `other` lies inside.
    pub(super) fn contains(&self, other: &Self) -> bool {
        other.left >= self.left && other.right <= self.right && other.top >= self.top && other.bottom <= self.bottom
    }

    /// True when the point lies inside.
    pub(super) fn holds(&self, (x, y): Point) -> bool {
        x >= self.left && x <= self.right && y >= self.top && y <= self.bottom
    }
}

/// A text inside its box, for labels: digits and capitals are about 0.7 em high.
pub(super) fn text_in(b: Box2, text: &str, em: f64, colour: Colour) -> Shape {
    let middle = ((b.left + b.right) / 2.0, (b.top + b.bottom) / 2.0 + 0.35 * em);
    Shape::Text { at: middle, text: text.to_owned(), em, colour, anchor: Anchor::Middle }
}

/// The box a text needs.
pub(super) fn box_of(text: &str, em: f64, centre: Point) -> Box2 {
    Box2::around(centre, text::width(text, em), 0.95 * em)
}
