//! Lays a plot out: margins, axes with their ticks, then the contents, then the names where there is room.

use super::axis::{Scale, Tick, TickLabel};
use super::content::{contents, symbol};
use super::shape::{Anchor, Box2, Point, Shape};
use super::style::{self, Colour, POINT_RADIUS};
use super::{HEIGHT, Key, Plot, PlotError, Stroke, WIDTH, text};

/// About how far apart ticks stand.
const TICK_SPACING: (f64, f64) = (105.0, 52.0);
/// Length of a tick and of a short tick.
const TICK_LENGTH: (f64, f64) = (6.0, 3.5);

/// The shapes of a plot, in the order of painting.
pub(super) fn lay_out(plot: &Plot) -> Result<Vec<Shape>, PlotError> {
    let (x_range, y_range) = ranges(plot)?;
    let key = whole_key(plot);
    let has_second_line = !(plot.subtitle.is_empty() && key.is_empty());
    let top = 40.0 + if has_second_line { 24.0 } else { 0.0 } + 32.0;
    let (bottom, right) = (HEIGHT - 62.0, WIDTH - 26.0);
    let y = Scale { axis: &plot.y, range: y_range, start: bottom, end: top };
    let y_ticks = y.ticks(TICK_SPACING.1);
    let widest = y_ticks.iter().map(|t| label_width(&t.label)).fold(0.0, f64::max);
    let left = (widest + TICK_LENGTH.0 + 18.0).max(48.0);
    let x = Scale { axis: &plot.x, range: x_range, start: left, end: right };
    let frame = Box2 { left, top, right, bottom };

    let mut shapes = Vec::new();
    headings(plot, &key, frame, &mut shapes);
    horizontal_axis(&x, frame, &mut shapes);
    vertical_axis(&y_ticks, &y, frame, &mut shapes);
    contents(plot, &x, &y, frame, &mut shapes);
    Ok(shapes)
}

type Range = (f64, f64);

/// What both axes show: all curves, markers, bars and rules.
fn ranges(plot: &Plot) -> Result<(Range, Range), PlotError> {
    let nothing = |axis| move || PlotError::Nothing { title: plot.title.clone(), axis };
    // A point counts only when both its coordinates can be shown.
    let on_curves = plot.curves.iter().flat_map(|c| c.x.iter().copied().zip(c.y.iter().copied()));
    let points = on_curves.chain(plot.markers.iter().map(|m| (m.x, m.y)));
    let shown: Vec<(f64, f64)> = points.filter(|&(x, y)| plot.x.shows(x) && plot.y.shows(y)).collect();
    let bar_sides = plot.bars.iter().flat_map(|b| [b.x - 0.7, b.x + 0.7]);
    let x_margin = if plot.bars.is_empty() { 0.015 } else { 0.0 };
    let x = plot.x.range_for(shown.iter().map(|p| p.0).chain(bar_sides), x_margin, nothing("x"))?;
    let heights = plot.bars.iter().map(|b| b.y).chain(plot.rules.iter().map(|r| r.y));
    let y = plot.y.range_for(shown.iter().map(|p| p.1).chain(heights), 0.06, nothing("y"))?;
    Ok((x, y))
}

/// Title, second line, and the name of the vertical axis above it, where it is read without turning the head.
fn headings(plot: &Plot, key: &[Key], frame: Box2, shapes: &mut Vec<Shape>) {
    let mut line = |text: &str, em: f64, baseline: f64, x: f64, colour: Colour| {
        let (text, em) = text::fit(text, em, WIDTH - x - 16.0);
        shapes.push(Shape::Text { at: (x, baseline), text, em, colour, anchor: Anchor::Start });
    };
    line(&plot.title, style::TITLE, 31.0, 16.0, Colour::Ink);
    line(&plot.y.label, style::NAME, frame.top - 13.0, 16.0, Colour::Ink);
    second_line(plot, key, 57.0, shapes);
    let (text, em) = text::fit(&plot.x.label, style::NAME, frame.right - frame.left);
    let at = (frame.right, frame.bottom + 48.0);
    shapes.push(Shape::Text { at, text, em, colour: Colour::Ink, anchor: Anchor::End });
}

/// The key as given, then the series of points.
fn whole_key(plot: &Plot) -> Vec<Key> {
    let series = plot.curves.iter().filter_map(|c| match c.stroke {
        Stroke::Points(symbol) if !c.label.is_empty() => Some(Key { symbol, colour: c.colour, label: c.label.clone() }),
        _ => None,
    });
    plot.key.iter().cloned().chain(series).collect()
}

/// Subtitle and key, as far as there is room.
fn second_line(plot: &Plot, key: &[Key], baseline: f64, shapes: &mut Vec<Shape>) {
    const GAP: f64 = 22.0;
    let mut x = 16.0;
    let put = |x: f64, text: &str, colour, shapes: &mut Vec<Shape>| {
        let (text, em) = text::fit(text, style::SUBTITLE, (WIDTH - x - 16.0).max(0.0));
        let end = x + text::width(&text, em);
        shapes.push(Shape::Text { at: (x, baseline), text, em, colour, anchor: Anchor::Start });
        end + GAP
    };
    if !plot.subtitle.is_empty() {
        x = put(x, &plot.subtitle, Colour::Grey, shapes);
    }
    for entry in key.iter().filter(|k| !k.label.is_empty()) {
        if x > WIDTH - 60.0 {
            break;
        }
        shapes.extend(symbol(entry.symbol, (x + POINT_RADIUS, baseline - 0.33 * style::SUBTITLE), entry.colour));
        x = put(x + 2.0 * POINT_RADIUS + 7.5, &entry.label, entry.colour, shapes);
    }
}

fn horizontal_axis(x: &Scale, frame: Box2, shapes: &mut Vec<Shape>) {
    let mut free_from = f64::NEG_INFINITY;
    let mut labels = Vec::new();
    for tick in x.ticks(TICK_SPACING.0) {
        let Some(at) = x.at(tick.value) else { continue };
        let half = label_width(&tick.label) / 2.0;
        let named = tick.label != TickLabel::None;
        if named && at - half > free_from {
            shapes.push(Shape::segment((at, frame.top), (at, frame.bottom), Colour::Faint, 1.0));
            free_from = at + half + 8.0;
            let start = (at - half).min(WIDTH - 4.0 - 2.0 * half);
            tick_label(&tick.label, (start, frame.bottom + 24.0), &mut labels);
        }
        let length = if named { TICK_LENGTH.0 } else { TICK_LENGTH.1 };
        labels.push(Shape::segment((at, frame.bottom), (at, frame.bottom + length), Colour::Grey, 1.2));
    }
    shapes.append(&mut labels);
    shapes.push(Shape::segment((frame.left, frame.bottom), (frame.right, frame.bottom), Colour::Grey, 1.2));
}

fn vertical_axis(ticks: &[Tick], y: &Scale, frame: Box2, shapes: &mut Vec<Shape>) {
    for tick in ticks {
        let Some(at) = y.at(tick.value) else { continue };
        let named = tick.label != TickLabel::None;
        if named {
            shapes.push(Shape::segment((frame.left, at), (frame.right, at), Colour::Faint, 1.0));
            let start = frame.left - TICK_LENGTH.0 - 6.0 - label_width(&tick.label);
            tick_label(&tick.label, (start, at + 0.35 * style::TICK), shapes);
        }
        let length = if named { TICK_LENGTH.0 } else { TICK_LENGTH.1 };
        shapes.push(Shape::segment((frame.left - length, at), (frame.left, at), Colour::Grey, 1.2));
    }
    shapes.push(Shape::segment((frame.left, frame.top), (frame.left, frame.bottom), Colour::Grey, 1.2));
}

/// The parts of a tick's number: text, em, rise. The exponent is raised by hand: few fonts have a
/// raised minus sign.
fn label_parts(label: &TickLabel) -> Vec<(String, f64, f64)> {
    match label {
        TickLabel::None => vec![],
        TickLabel::Plain(text) => vec![(text.clone(), style::TICK, 0.0)],
        TickLabel::Power(mantissa, exponent) => {
            let base = if mantissa.is_empty() { "10".to_owned() } else { format!("{mantissa}·10") };
            let exponent = super::axis::minus(exponent.to_string());
            vec![(base, style::TICK, 0.0), (exponent, style::EXPONENT, 0.42 * style::TICK)]
        }
    }
}

fn label_width(label: &TickLabel) -> f64 {
    label_parts(label).iter().map(|(text, em, _)| text::width(text, *em)).sum()
}

fn tick_label(label: &TickLabel, (mut x, baseline): Point, shapes: &mut Vec<Shape>) {
    for (text, em, rise) in label_parts(label) {
        let width = text::width(&text, em);
        shapes.push(Shape::Text { at: (x, baseline - rise), text, em, colour: Colour::Ink, anchor: Anchor::Start });
        x += width;
    }
}
