//! Paints laid-out shapes as SVG text and as PNG bytes.

use super::png::encode;
use super::shape::{Anchor, Point, Shape};
use super::style::Colour;
use super::text::{FAMILY, rasterise, width};
use super::{HEIGHT, WIDTH};
use crate::report::escape;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Whole units per SVG unit: the library draws on whole units only.
const SVG_GRAIN: f64 = 10.0;
/// PNG pixels per SVG unit.
const PNG_SCALE: usize = 2;
/// Pixels painted per PNG pixel and direction; their mean smooths edges.
const OVERSAMPLING: usize = 2;

/// A painter: where to paint and how this back end sizes things.
struct Painter<'a, DB: DrawingBackend> {
    area: &'a DrawingArea<DB, Shift>,
    scale: f64,
    /// Text and wide lines as pixels of our own: the library's wide lines tear at sharp turns, and
    /// its text ignores the room left and right of a glyph.
    as_pixels: bool,
}

/// An `<svg>` element with a title for screen readers.
pub(super) fn svg(shapes: &[Shape], title: &str) -> Result<String, String> {
    let mut text = String::new();
    let (w, h) = ((WIDTH * SVG_GRAIN) as u32, (HEIGHT * SVG_GRAIN) as u32);
    {
        let area = SVGBackend::with_string(&mut text, (w, h)).into_drawing_area();
        let painter = Painter { area: &area, scale: SVG_GRAIN, as_pixels: false };
        painter.all(shapes)?;
    }
    let open = format!("<svg width=\"{w}\" height=\"{h}\"");
    let named = format!("<svg role=\"img\" aria-label=\"{}\" width=\"{WIDTH}\" height=\"{HEIGHT}\"", escape(title));
    Ok(with_text_widths(&text.replacen(&open, &named, 1), shapes))
}

/// Each `<text>` told how wide it is in the embedded font, so that it fits whatever font the viewer has.
fn with_text_widths(svg: &str, shapes: &[Shape]) -> String {
    let widths = shapes.iter().filter_map(|s| match s {
        Shape::Text { text, em, .. } => Some((width(text, *em) * SVG_GRAIN).round()),
        _ => None,
    });
    let mut parts = svg.split("<text ");
    let mut told = parts.next().unwrap_or_default().to_owned();
    for (part, width) in parts.zip(widths) {
        told += &format!("<text textLength=\"{width}\" lengthAdjust=\"spacingAndGlyphs\" {part}");
    }
    told
}

/// A PNG file.
pub(super) fn png(shapes: &[Shape]) -> Result<Vec<u8>, String> {
    let (w, h) = (WIDTH as usize * PNG_SCALE, HEIGHT as usize * PNG_SCALE);
    let (fine_w, fine_h) = (w * OVERSAMPLING, h * OVERSAMPLING);
    let mut fine = vec![0xff; fine_w * fine_h * 3];
    {
        let area = BitMapBackend::with_buffer(&mut fine, (fine_w as u32, fine_h as u32)).into_drawing_area();
        let painter = Painter { area: &area, scale: (PNG_SCALE * OVERSAMPLING) as f64, as_pixels: true };
        painter.all(shapes)?;
    }
    Ok(encode(&mean(&fine, w, h), w as u32, h as u32))
}

/// Each pixel the mean of OVERSAMPLING² fine ones.
fn mean(fine: &[u8], w: usize, h: usize) -> Vec<u8> {
    let row = w * OVERSAMPLING * 3;
    let mut pixels = Vec::with_capacity(w * h * 3);
    for y in 0..h {
        for x in 0..w {
            for channel in 0..3 {
                let at = |dy: usize, dx: usize| {
                    u32::from(fine[(y * OVERSAMPLING + dy) * row + (x * OVERSAMPLING + dx) * 3 + channel])
                };
                let sum = at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1);
                pixels.push((sum / 4) as u8);
            }
        }
    }
    pixels
}

fn rgb(colour: Colour) -> RGBColor {
    let (r, g, b) = colour.rgb();
    RGBColor(r, g, b)
}

impl<DB: DrawingBackend> Painter<'_, DB> {
    fn all(&self, shapes: &[Shape]) -> Result<(), String> {
        self.area.fill(&WHITE).map_err(|e| e.to_string())?;
        for shape in shapes {
            self.one(shape).map_err(|e| e.to_string())?;
        }
        self.area.present().map_err(|e| e.to_string())
    }

    fn at(&self, (x, y): Point) -> (i32, i32) {
        ((x * self.scale).round() as i32, (y * self.scale).round() as i32)
    }

    fn one(&self, shape: &Shape) -> Result<(), DrawingAreaErrorKind<DB::ErrorType>> {
        match shape {
            Shape::Line { points, colour, width } if self.as_pixels => self.wide_line(points, *colour, *width),
            Shape::Line { points, colour, width } => {
                let style = rgb(*colour).stroke_width((width * self.scale).round().max(1.0) as u32);
                self.area.draw(&PathElement::new(points.iter().map(|&p| self.at(p)).collect::<Vec<_>>(), style))
            }
            Shape::Area { points, colour } => {
                let corners: Vec<_> = points.iter().map(|&p| self.at(p)).collect();
                self.area.draw(&Polygon::new(corners, rgb(*colour).filled()))
            }
            Shape::Disc { centre, radius, colour } => self.area.draw(&Circle::new(
                self.at(*centre),
                (radius * self.scale).round() as u32,
                rgb(*colour).filled(),
            )),
            Shape::Text { at, text, em, colour, anchor } if self.as_pixels => {
                let align = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => 0.5,
                    Anchor::End => 1.0,
                };
                let at = (at.0 * self.scale, at.1 * self.scale);
                let ink = rgb(*colour);
                rasterise(text, em * self.scale, at, align, |x, y, cover| self.area.draw_pixel((x, y), &ink.mix(cover)))
                    .map(|_| ())
            }
            Shape::Text { at, text, em, colour, anchor } => {
                let horizontal = match anchor {
                    Anchor::Start => HPos::Left,
                    Anchor::Middle => HPos::Center,
                    Anchor::End => HPos::Right,
                };
                // The SVG back end writes font-size = size/1.24 and shifts top-anchored text by 0.76 em.
                let ink = rgb(*colour);
                let style = TextStyle::from((FAMILY, em * 1.24 * self.scale).into_font())
                    .color(&ink)
                    .pos(Pos::new(horizontal, VPos::Top));
                self.area.draw_text(text, &style, self.at((at.0, at.1 - em * 0.76)))
            }
        }
    }

    fn wide_line(
        &self,
        points: &[Point],
        colour: Colour,
        width: f64,
    ) -> Result<(), DrawingAreaErrorKind<DB::ErrorType>> {
        let fill = rgb(colour).filled();
        let half = width / 2.0;
        for (k, pair) in points.windows(2).enumerate() {
            let (a, b) = (pair[0], pair[1]);
            let (dx, dy) = (b.0 - a.0, b.1 - a.1);
            let length = dx.hypot(dy);
            if length > 0.0 {
                let (nx, ny) = (-dy / length * half, dx / length * half);
                let corners = [(a.0 + nx, a.1 + ny), (b.0 + nx, b.1 + ny), (b.0 - nx, b.1 - ny), (a.0 - nx, a.1 - ny)];
                self.area.draw(&Polygon::new(corners.map(|p| self.at(p)).to_vec(), fill))?;
            }
            // Thin lines need no round joints.
            if k > 0 && width > 1.5 {
                self.area.draw(&Circle::new(self.at(a), (half * self.scale).round() as u32, fill))?;
            }
        }
        Ok(())
    }
}
