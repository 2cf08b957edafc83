//! Curves on their way to the picture: gaps, clipping, thinning, dashes.

use super::shape::{Box2, Point};

/// Columns per SVG unit in which a curve keeps only first, least, largest and last point: one per PNG pixel.
const COLUMNS: f64 = 2.0;

/// Runs of a curve inside the frame. `None` is a gap.
pub(super) fn runs(points: impl Iterator<Item = Option<Point>>, frame: Box2) -> Vec<Vec<Point>> {
    let mut whole: Vec<Vec<Point>> = vec![Vec::new()];
    for point in points {
        match (point, whole.last_mut()) {
            (Some(p), Some(run)) => run.push(p),
            _ => whole.push(Vec::new()),
        }
    }
    whole.iter().filter(|run| !run.is_empty()).flat_map(|run| clip(&thin(run), frame)).collect()
}

/// At most four points per column: first, least, largest, last, in their order. No extreme is lost.
pub(super) fn thin(points: &[Point]) -> Vec<Point> {
    let column = |p: &Point| (p.0 * COLUMNS).floor();
    let mut kept = Vec::with_capacity(points.len().min(8192));
    let mut start = 0;
    while start < points.len() {
        let same = points[start..].iter().take_while(|p| column(p) == column(&points[start])).count().max(1);
        let group = &points[start..start + same];
        let by_height = |a: &usize, b: &usize| group[*a].1.total_cmp(&group[*b].1);
        let least = (0..same).min_by(by_height).unwrap_or(0);
        let largest = (0..same).max_by(by_height).unwrap_or(0);
        let mut chosen = [0, least, largest, same - 1];
        chosen.sort_unstable();
        for (k, &index) in chosen.iter().enumerate() {
            if k == 0 || index != chosen[k - 1] {
                kept.push(group[index]);
            }
        }
        start += same;
    }
    kept
}

/// The parts of a line inside the frame.
fn clip(points: &[Point], frame: Box2) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    if let [only] = points {
        return if frame.holds(*only) { vec![vec![*only]] } else { vec![] };
    }
    let mut connected = false;
    for pair in points.windows(2) {
        match clip_segment(pair[0], pair[1], frame) {
            Some((a, b)) => {
                match parts.last_mut() {
                    Some(part) if connected => part.push(b),
                    _ => parts.push(vec![a, b]),
                }
                connected = b == pair[1];
            }
            None => connected = false,
        }
    }
    parts
}

/// Liang and Barsky, ACM Trans. Graphics 3 (1984) 1: the part of a segment inside a rectangle.
fn clip_segment(a: Point, b: Point, frame: Box2) -> Option<(Point, Point)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let sides = [(-dx, a.0 - frame.left), (dx, frame.right - a.0), (-dy, a.1 - frame.top), (dy, frame.bottom - a.1)];
    for (slope, room) in sides {
        if slope == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if slope < 0.0 {
            enter = enter.max(room / slope);
        } else {
            leave = leave.min(room / slope);
        }
    }
    let at = |s: f64| (a.0 + s * dx, a.1 + s * dy);
    (enter <= leave).then(|| (if enter > 0.0 { at(enter) } else { a }, if leave < 1.0 { at(leave) } else { b }))
}

/// A line cut into dashes of the given length and gap.
pub(super) fn dashes(points: &[Point], dash: f64, gap: f64) -> Vec<Vec<Point>> {
    let mut parts = Vec::new();
    let mut part: Vec<Point> = points.first().copied().into_iter().collect();
    let (mut drawing, mut left) = (true, dash);
    for pair in points.windows(2) {
        let (mut a, b) = (pair[0], pair[1]);
        loop {
            let length = (b.0 - a.0).hypot(b.1 - a.1);
            if length <= left || !length.is_finite() {
                left -= length;
                part.push(b);
                break;
            }
            let s = left / length;
            a = (a.0 + s * (b.0 - a.0), a.1 + s * (b.1 - a.1));
            part.push(a);
            if drawing {
                parts.push(std::mem::take(&mut part));
            }
            part = vec![a];
            drawing = !drawing;
            left = if drawing { dash } else { gap };
        }
    }
    if drawing && part.len() > 1 {
        parts.push(part);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Box2 = Box2 { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };

    #[test]
    fn thinning_keeps_every_extreme() {
        let mut points: Vec<Point> = (0..100_000).map(|k| (k as f64 * 1e-3, (k as f64 * 0.01).sin())).collect();
        points[54_321].1 = 7.0;
        points[54_322].1 = -9.0;
        let thinned = thin(&points);
        assert!(thinned.len() <= 4 * 200, "{}", thinned.len());
        assert!(thinned.contains(&points[54_321]) && thinned.contains(&points[54_322]));
        assert_eq!((thinned.first(), thinned.last()), (points.first(), points.last()));
        assert!(thinned.windows(2).all(|w| w[0].0 < w[1].0), "order is kept");
    }

    #[test]
    fn few_points_stay_as_they_are() {
        let points = [(0.0, 1.0), (10.0, 2.0), (5.0, 3.0), (5.0, 3.0)];
        assert_eq!(thin(&points)[..3], points[..3]);
        assert!(thin(&[]).is_empty());
    }

    #[test]
    fn curves_are_cut_at_the_frame_and_at_gaps() {
        let points = [Some((-50.0, 50.0)), Some((50.0, 50.0)), None, Some((60.0, 50.0)), Some((60.0, 150.0))];
        let runs = runs(points.into_iter(), FRAME);
        assert_eq!(runs, [vec![(0.0, 50.0), (50.0, 50.0)], vec![(60.0, 50.0), (60.0, 100.0)]]);
        let outside = [Some((-5.0, -5.0)), Some((-1.0, 200.0))];
        assert!(super::runs(outside.into_iter(), FRAME).is_empty());
    }

    #[test]
    fn dashes_cover_their_share() {
        let parts = dashes(&[(0.0, 0.0), (35.0, 0.0), (100.0, 0.0)], 6.0, 4.0);
        let length: f64 = parts.iter().map(|p| p[p.len() - 1].0 - p[0].0).sum();
        assert_eq!(parts.len(), 10);
        assert!((length - 60.0).abs() < 1e-9);
    }
}
