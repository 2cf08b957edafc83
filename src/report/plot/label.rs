//! Finds room for names: a coarse map of what is taken, and the freest of several candidate places.

use super::shape::{Box2, Point};
use super::{HEIGHT, WIDTH};

/// Side of a cell of the map, SVG units.
const CELL: f64 = 3.0;
/// Weight of a curve in a cell; texts and points weigh more, since nothing may cover them.
pub(super) const CURVE: u8 = 1;
/// Weight of a text or point.
pub(super) const SOLID: u8 = 6;

/// What is taken, cell by cell.
pub(super) struct Taken {
    columns: usize,
    rows: usize,
    weight: Vec<u8>,
}

/// A place for a label and how bad it is: 0 is free.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) at: Box2,
    /// Sum of the weights that it would cover.
    pub(super) covers: f64,
}

impl Taken {
    /// Nothing taken.
    pub(super) fn new() -> Self {
        let (columns, rows) = ((WIDTH / CELL).ceil() as usize, (HEIGHT / CELL).ceil() as usize);
        Self { columns, rows, weight: vec![0; columns * rows] }
    }

    /// Takes a rectangle.
    pub(super) fn take_box(&mut self, b: Box2, weight: u8) {
        for cell in self.cells(b) {
            self.weight[cell] = self.weight[cell].max(weight);
        }
    }

    /// Takes a line.
    pub(super) fn take_line(&mut self, points: &[Point]) {
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let steps = ((b.0 - a.0).hypot(b.1 - a.1) / CELL).ceil().clamp(1.0, 1e4) as usize;
            for k in 0..=steps {
                let s = k as f64 / steps as f64;
                self.take_box(Box2::around((a.0 + s * (b.0 - a.0), a.1 + s * (b.1 - a.1)), 1.0, 1.0), CURVE);
            }
        }
    }

    /// Sum of the weights inside a rectangle.
    fn covered(&self, b: Box2) -> f64 {
        self.cells(b).map(|cell| f64::from(self.weight[cell])).sum()
    }

    /// Sum of the weights along a straight line, but near its beginning, where the point is that it starts from.
    pub(super) fn along(&self, from: Point, to: Point) -> f64 {
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let steps = (length / CELL).floor().min(1e4) as usize;
        let at = |k: usize| {
            let s = k as f64 * CELL / length;
            (from.0 + s * (to.0 - from.0), from.1 + s * (to.1 - from.1))
        };
        (2..steps).map(|k| self.covered(Box2::around(at(k), 0.0, 0.0))).sum()
    }

    /// The candidate (with its own cost in cells) that covers least, then is least crowded, inside `frame`.
    pub(super) fn best(&self, candidates: impl Iterator<Item = (Box2, f64)>, frame: Box2) -> Option<Place> {
        let mut best: Option<(f64, Place)> = None;
        for (at, cost) in candidates.filter(|(at, _)| frame.contains(at)) {
            let covers = self.covered(at.grown(1.0));
            let crowd = self.covered(at.grown(12.0)) - covers;
            let score = 8.0 * covers + 0.25 * crowd + cost;
            if best.as_ref().is_none_or(|(least, _)| score < *least) {
                best = Some((score, Place { at, covers }));
            }
        }
        best.map(|(_, place)| place)
    }

    fn cells(&self, b: Box2) -> impl Iterator<Item = usize> + use<> {
        let index = |v: f64, count: usize| (v / CELL).floor().clamp(0.0, count as f64 - 1.0) as usize;
        let (left, right) = (index(b.left, self.columns), index(b.right, self.columns));
        let (top, bottom) = (index(b.top, self.rows), index(b.bottom, self.rows));
        let columns = self.columns;
        (top..=bottom).flat_map(move |row| (left..=right).map(move |column| row * columns + column))
    }
}

/// Places around a point for a box of the given size, nearest first; further ones cost more.
pub(super) fn around_point((x, y): Point, width: f64, height: f64) -> Vec<(Box2, f64)> {
    let directions =
        [(0.0, -1.0), (0.8, -0.7), (-0.8, -0.7), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.8, 0.7), (-0.8, 0.7)];
    let mut places = Vec::new();
    for (ring, gap) in [9.5, 18.0, 30.0, 44.0, 60.0].into_iter().enumerate() {
        for (k, (dx, dy)) in directions.into_iter().enumerate() {
            let centre = (x + dx * (width / 2.0 + gap), y + dy * (height / 2.0 + gap));
            places.push((Box2::around(centre, width, height), 14.0 * ring as f64 + k as f64));
        }
    }
    places
}

/// Places along a line for its name: above, below and beside it. A place far from where it begins
/// costs nothing more.
pub(super) fn along_line(points: &[Point], width: f64, height: f64) -> Vec<(Box2, f64)> {
    let every = (points.len() / 160).max(1);
    let (up, side) = (height / 2.0 + 5.0, width / 2.0 + 8.0);
    let offsets =
        [(0.0, -up), (0.0, up), (side, 0.0), (-side, 0.0), (side, -up), (-side, -up), (side, up), (-side, up)];
    let place = |p: &Point, (dx, dy): (f64, f64)| (Box2::around((p.0 + dx, p.1 + dy), width, height), 0.0);
    points.iter().step_by(every).flat_map(|p| offsets.into_iter().map(move |o| place(p, o))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Box2 = Box2 { left: 0.0, top: 0.0, right: WIDTH, bottom: HEIGHT };

    #[test]
    fn a_label_moves_out_of_the_way() {
        let mut taken = Taken::new();
        let point = (300.0, 200.0);
        let first = taken.best(around_point(point, 30.0, 16.0).into_iter(), FRAME).expect("room");
        assert!(first.covers == 0.0 && first.at.bottom < 200.0, "above by default");
        taken.take_box(first.at, SOLID);
        let second = taken.best(around_point(point, 30.0, 16.0).into_iter(), FRAME).expect("room");
        assert_eq!(second.covers, 0.0);
        assert!(second.at.left > first.at.right || second.at.right < first.at.left || second.at.top > first.at.bottom);
    }

    #[test]
    fn no_place_outside_the_frame() {
        let tight = Box2::around((300.0, 200.0), 20.0, 20.0);
        assert!(Taken::new().best(around_point((300.0, 200.0), 30.0, 16.0).into_iter(), tight).is_none());
        assert!(along_line(&[], 10.0, 10.0).is_empty());
    }
}
