//! Lays out what stands between the axes: rules, bars, curves, points, and their names.

use super::axis::Scale;
use super::curve::{dashes, runs};
use super::label::{SOLID, Taken, along_line, around_point};
use super::shape::{Box2, Point, Shape, box_of, text_in};
use super::style::{self, CURVE_WIDTH, Colour, POINT_RADIUS};
use super::{Curve, Marker, Plot, Stroke, Symbol, text};

/// Width of a bar, in units of the x axis.
const BAR_WIDTH: f64 = 0.72;

/// A name that still needs a place.
struct Name<'a> {
    text: &'a str,
    colour: Colour,
    points: Vec<Point>,
}

/// Appends the contents of a plot.
pub(super) fn contents(plot: &Plot, x: &Scale, y: &Scale, frame: Box2, shapes: &mut Vec<Shape>) {
    let mut taken = Taken::new();
    let mut names = Vec::new();
    bars(plot, x, y, frame, &mut taken, shapes);
    for rule in &plot.rules {
        if let Some(at) = y.at(rule.y).filter(|&at| at >= frame.top && at <= frame.bottom) {
            let line = vec![(frame.left, at), (frame.right, at)];
            taken.take_line(&line);
            shapes.extend(dashed(&line, rule.colour, 1.5));
            let places = (0..=100).map(|k| (frame.right - (frame.right - frame.left) * f64::from(k) / 100.0, at));
            names.push(Name { text: &rule.label, colour: rule.colour, points: places.collect() });
        }
    }
    for curve in &plot.curves {
        let points = draw_curve(curve, x, y, frame, &mut taken, shapes);
        // A series of points is named in the key.
        if !matches!(curve.stroke, Stroke::Points(_)) {
            names.push(Name { text: &curve.label, colour: curve.colour, points });
        }
    }
    let placed: Vec<(&Marker, Point)> =
        plot.markers.iter().filter_map(|m| Some((m, on_frame(m, x, y, frame)?))).collect();
    for &(marker, at) in &placed {
        taken.take_box(Box2::around(at, 2.0 * POINT_RADIUS, 2.0 * POINT_RADIUS), SOLID);
        shapes.extend(symbol(marker.symbol, at, marker.colour));
    }
    let (mut must, may): (Vec<_>, Vec<_>) = placed.into_iter().partition(|(m, _)| m.always_named);
    // From the top, where names go first: else a lower point's name takes the room of a higher one.
    must.sort_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
    must.into_iter().for_each(|(m, at)| name_marker(m, at, frame, &mut taken, shapes));
    names.into_iter().for_each(|n| name_line(&n, frame, &mut taken, shapes));
    may.into_iter().for_each(|(m, at)| name_marker(m, at, frame, &mut taken, shapes));
}

fn on_frame(marker: &Marker, x: &Scale, y: &Scale, frame: Box2) -> Option<Point> {
    let at = (x.at(marker.x)?, y.at(marker.y)?);
    frame.grown(1e-6).holds(at).then_some(at)
}

fn bars(plot: &Plot, x: &Scale, y: &Scale, frame: Box2, taken: &mut Taken, shapes: &mut Vec<Shape>) {
    let foot = y.at(0.0).unwrap_or(frame.bottom).clamp(frame.top, frame.bottom);
    for bar in &plot.bars {
        let (Some(left), Some(right)) = (x.at(bar.x - BAR_WIDTH / 2.0), x.at(bar.x + BAR_WIDTH / 2.0)) else {
            continue;
        };
        if right < frame.left || left > frame.right {
            continue;
        }
        match y.at(bar.y).map(|top| top.clamp(frame.top, frame.bottom)) {
            Some(top) if (top - foot).abs() > 0.05 => {
                let area = Box2 { left, right, top: top.min(foot), bottom: top.max(foot) };
                taken.take_box(area, SOLID);
                shapes.push(Shape::rectangle(area, bar.colour));
            }
            _ => {
                let em = (right - left).clamp(8.0, 13.0);
                let area = box_of("0", em, ((left + right) / 2.0, foot - 0.7 * em));
                taken.take_box(area, SOLID);
                shapes.push(text_in(area, "0", em, bar.colour));
            }
        }
    }
}

/// Draws a curve; returns its points on the picture.
fn draw_curve(c: &Curve, x: &Scale, y: &Scale, frame: Box2, taken: &mut Taken, shapes: &mut Vec<Shape>) -> Vec<Point> {
    let mapped = c.x.iter().zip(&c.y).map(|(&a, &b)| Some((x.at(a)?, y.at(b)?)));
    if let Stroke::Points(kind) = c.stroke {
        let points: Vec<Point> = mapped.flatten().filter(|&p| frame.grown(1e-6).holds(p)).collect();
        for &p in &points {
            taken.take_box(Box2::around(p, 2.0 * POINT_RADIUS, 2.0 * POINT_RADIUS), SOLID);
            shapes.extend(symbol(kind, p, c.colour));
        }
        return points;
    }
    let mut all = Vec::new();
    for run in runs(mapped, frame) {
        taken.take_line(&run);
        match (c.stroke, run.as_slice()) {
            (_, [only]) => shapes.push(Shape::Disc { centre: *only, radius: CURVE_WIDTH, colour: c.colour }),
            (Stroke::Dashed, _) => shapes.extend(dashed(&run, c.colour, CURVE_WIDTH)),
            _ => shapes.push(Shape::Line { points: run.clone(), colour: c.colour, width: CURVE_WIDTH }),
        }
        all.extend(run);
    }
    all
}

fn dashed(points: &[Point], colour: Colour, width: f64) -> impl Iterator<Item = Shape> {
    dashes(points, 7.0, 5.0).into_iter().map(move |points| Shape::Line { points, colour, width })
}

/// A point's shape, with a thin white edge so that it stands out from the curve below.
pub(super) fn symbol(kind: Symbol, at: Point, colour: Colour) -> Vec<Shape> {
    let disc = |radius: f64, colour| Shape::Disc { centre: at, radius, colour };
    let r = POINT_RADIUS;
    let arm = |sign: f64, width, colour| {
        let d = 0.95 * r;
        Shape::segment((at.0 - d, at.1 - sign * d), (at.0 + d, at.1 + sign * d), colour, width)
    };
    match kind {
        Symbol::Disc => vec![disc(r + 1.2, Colour::White), disc(r, colour)],
        Symbol::Dot => vec![disc(0.6 * r, colour)],
        Symbol::Ring => vec![disc(0.85 * r, colour), disc(0.85 * r - 1.5, Colour::White)],
        Symbol::Square => vec![Shape::rectangle(Box2::around(at, 2.0 * r, 2.0 * r), colour)],
        Symbol::Diamond => {
            let corners = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 0.0)];
            let points: Vec<Point> = corners.map(|(x, y)| (at.0 + 1.5 * r * x, at.1 + 1.5 * r * y)).to_vec();
            vec![
                Shape::Line { points: points.clone(), colour: Colour::White, width: 4.5 },
                Shape::Line { points, colour, width: 2.2 },
            ]
        }
        Symbol::Cross => vec![
            arm(1.0, 5.0, Colour::White),
            arm(-1.0, 5.0, Colour::White),
            arm(1.0, 2.4, colour),
            arm(-1.0, 2.4, colour),
        ],
    }
}

/// Names a point: beside it, or further away with a leader line; an optional name only in free room.
fn name_marker(marker: &Marker, at: Point, frame: Box2, taken: &mut Taken, shapes: &mut Vec<Shape>) {
    if marker.label.is_empty() {
        return;
    }
    let em = if marker.always_named { style::NAME } else { 0.85 * style::NAME };
    let size = box_of(&marker.label, em, at);
    let mut places = around_point(at, size.right - size.left, size.bottom - size.top);
    if !marker.always_named {
        places.truncate(8);
    }
    // A leader line over other things costs as well.
    for (place, cost) in &mut places {
        *cost += leader(at, *place).map_or(0.0, |(from, to)| 12.0 * taken.along(from, to));
    }
    let Some(place) = taken.best(places.into_iter(), frame.grown(-5.0)) else { return };
    if !marker.always_named && place.covers > 0.0 {
        return;
    }
    if let Some((from, to)) = leader(at, place.at) {
        shapes.push(Shape::segment(from, to, Colour::Grey, 0.9));
        taken.take_line(&[from, to]);
    }
    taken.take_box(place.at, SOLID);
    shapes.push(text_in(place.at, &marker.label, em, marker.colour));
}

/// The line from a point to a name that does not stand right beside it.
fn leader(at: Point, place: Box2) -> Option<(Point, Point)> {
    let to = (at.0.clamp(place.left, place.right), at.1.clamp(place.top, place.bottom));
    let away = (to.0 - at.0).hypot(to.1 - at.1);
    let start = (POINT_RADIUS + 2.0) / away;
    (away > 13.0).then_some(((at.0 + start * (to.0 - at.0), at.1 + start * (to.1 - at.1)), to))
}

/// Names a curve or rule in its colour, where it is free along its line.
fn name_line(name: &Name, frame: Box2, taken: &mut Taken, shapes: &mut Vec<Shape>) {
    if name.text.is_empty() || name.points.is_empty() {
        return;
    }
    let (text, em) = text::fit(name.text, style::NAME, 0.6 * (frame.right - frame.left));
    let size = box_of(&text, em, (0.0, 0.0));
    let places = along_line(&name.points, size.right - size.left, size.bottom - size.top);
    let Some(place) = taken.best(places.into_iter(), frame.grown(-5.0)) else { return };
    taken.take_box(place.at, SOLID);
    shapes.push(text_in(place.at, &text, em, name.colour));
}
