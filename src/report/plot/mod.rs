//! One way to draw: curves, points, bars and rules over two axes, as SVG and PNG from the same shapes.
//!
//! A plot is laid out once into a list of shapes, in a frame of 900 × 520, and the list is
//! painted twice. Curves carry their names themselves, placed where nothing else stands.

mod axis;
mod content;
mod curve;
mod frame;
mod label;
mod paint;
mod png;
mod shape;
mod style;
mod text;

pub use axis::{Axis, ScaleKind};
pub use style::Colour;

use thiserror::Error;

/// Width of a picture, in SVG units; the PNG has twice as many pixels.
pub const WIDTH: f64 = 900.0;
/// Height of a picture, in SVG units; the PNG has twice as many pixels.
pub const HEIGHT: f64 = 520.0;

/// A drawn plot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// An `<svg>` element that stands alone or inside HTML; its text is escaped.
    pub svg: String,
    /// A PNG file, 1800 × 1040.
    pub png: Vec<u8>,
}

/// Everything there is to draw.
#[derive(Clone, Debug, Default)]
pub struct Plot {
    /// What the picture shows.
    pub title: String,
    /// A second, smaller line; empty for none.
    pub subtitle: String,
    /// What symbols and colours mean, behind the second line. Series of points are added to it.
    pub key: Vec<Key>,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Horizontal lines with a meaning.
    pub rules: Vec<Rule>,
    /// Bars.
    pub bars: Vec<Bar>,
    /// Curves and series of points.
    pub curves: Vec<Curve>,
    /// Single points with a meaning.
    pub markers: Vec<Marker>,
}

/// How the points of a curve are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// A line.
    Solid,
    /// A broken line.
    Dashed,
    /// Not joined: symbols.
    Points(Symbol),
}

/// The shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// ●
    Disc,
    /// A small ●
    Dot,
    /// ○
    Ring,
    /// ◇
    Diamond,
    /// ×
    Cross,
    /// ■
    Square,
}

/// What a symbol means.
#[derive(Clone, Debug)]
pub struct Key {
    /// Its shape.
    pub symbol: Symbol,
    /// Its colour.
    pub colour: Colour,
    /// Its meaning.
    pub label: String,
}

/// A curve with its name. Points that are not finite (or not positive on a logarithmic axis) leave gaps.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name, drawn beside it (of a series of points: in the key); empty for none.
    pub label: String,
    /// In the unit of the x axis.
    pub x: Vec<f64>,
    /// In the unit of the y axis.
    pub y: Vec<f64>,
    /// Colour of line and name.
    pub colour: Colour,
    /// Line or points.
    pub stroke: Stroke,
}

/// A point with a meaning; not drawn when it lies outside the axes or is not finite.
#[derive(Clone, Debug)]
pub struct Marker {
    /// In the unit of the x axis.
    pub x: f64,
    /// In the unit of the y axis.
    pub y: f64,
    /// Its name; empty for none.
    pub label: String,
    /// Colour of symbol and name.
    pub colour: Colour,
    /// Its shape.
    pub symbol: Symbol,
    /// True: named even in a crowd, if need be by a leader line. False: named only where there is room.
    pub always_named: bool,
}

/// A horizontal line with a name.
#[derive(Clone, Debug)]
pub struct Rule {
    /// In the unit of the y axis.
    pub y: f64,
    /// Its name; empty for none.
    pub label: String,
    /// Colour of line and name.
    pub colour: Colour,
}

/// A bar from the bottom of the plot (or from zero on a linear axis); one that cannot be shown
/// (0 on a logarithmic axis) leaves a "0" on the axis.
#[derive(Clone, Debug)]
pub struct Bar {
    /// Its middle, in the unit of the x axis; bars are 0.72 wide.
    pub x: f64,
    /// Its height, in the unit of the y axis.
    pub y: f64,
    /// Colour.
    pub colour: Colour,
}

/// Why a plot cannot be drawn.
#[derive(Debug, Error, PartialEq)]
pub enum PlotError {
    /// x and y of a curve differ in length.
    #[error("curve \"{curve}\" has {x} abscissae and {y} ordinates; expected as many of both")]
    Lengths {
        /// Its label.
        curve: String,
        /// Number of x.
        x: usize,
        /// Number of y.
        y: usize,
    },
    /// Nothing finite (and positive on a logarithmic axis) to show.
    #[error(
        "plot \"{title}\" has no point to show on its {axis} axis; expected finite values, positive on a logarithmic axis"
    )]
    Nothing {
        /// Title of the plot.
        title: String,
        /// "x" or "y".
        axis: &'static str,
    },
    /// An axis range that is empty, not finite, or not positive on a logarithmic axis.
    #[error(
        "axis \"{axis}\" was given the range {from} to {to}; expected from < to, finite, positive when logarithmic"
    )]
    Range {
        /// Label of the axis.
        axis: String,
        /// Its start.
        from: f64,
        /// Its end.
        to: f64,
    },
    /// The drawing library failed.
    #[error("plot \"{title}\" cannot be painted: {reason}")]
    Paint {
        /// Title of the plot.
        title: String,
        /// What the library says.
        reason: String,
    },
}

/// Draws a plot. The same plot gives the same bytes, on every machine.
///
/// # Errors
/// [`PlotError`] when x and y differ in length, nothing can be shown, or a given range is unusable.
pub fn draw(plot: &Plot) -> Result<Picture, PlotError> {
    for c in &plot.curves {
        if c.x.len() != c.y.len() {
            return Err(PlotError::Lengths { curve: c.label.clone(), x: c.x.len(), y: c.y.len() });
        }
    }
    let shapes = frame::lay_out(plot)?;
    let failed = |reason| PlotError::Paint { title: plot.title.clone(), reason };
    let svg = paint::svg(&shapes, &plot.title).map_err(failed)?;
    let png = paint::png(&shapes).map_err(failed)?;
    Ok(Picture { svg, png })
}

#[cfg(test)]
mod tests;
