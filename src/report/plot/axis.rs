//! Axes: range, scale, and where the ticks stand.

use super::PlotError;

/// How values become lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ScaleKind {
    /// Equal differences, equal lengths.
    #[default]
    Linear,
    /// Equal ratios, equal lengths.
    Log,
}

/// An axis as it is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What it shows, with its unit: "ω (rad/s)".
    pub label: String,
    /// Linear or logarithmic.
    pub scale: ScaleKind,
    /// First and last value; `None` fits the data.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis that fits the data.
    pub fn linear(label: &str) -> Self {
        Self { label: label.into(), scale: ScaleKind::Linear, range: None }
    }

    /// A logarithmic axis that fits the data.
    pub fn log(label: &str) -> Self {
        Self { label: label.into(), scale: ScaleKind::Log, range: None }
    }

    /// True when the value can be shown on this axis.
    pub(super) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale == ScaleKind::Linear || value > 0.0)
    }

    /// The range given, or the range of the values widened by `margin` of its length on both sides.
    pub(super) fn range_for(
        &self,
        values: impl Iterator<Item = f64>,
        margin: f64,
        nothing: impl FnOnce() -> PlotError,
    ) -> Result<(f64, f64), PlotError> {
        if let Some((from, to)) = self.range {
            let usable = self.shows(from) && self.shows(to) && from < to && (to - from).is_finite();
            return if usable { Ok((from, to)) } else { Err(PlotError::Range { axis: self.label.clone(), from, to }) };
        }
        let shown = values.filter(|&v| self.shows(v)).map(|v| self.forward(v));
        let (low, high) = shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        if low > high {
            return Err(nothing());
        }
        // A single value gets an axis around it: a decade, or a tenth of its size.
        let length = match self.scale {
            _ if high - low > 1e-12 * low.abs().max(high.abs()) => high - low,
            ScaleKind::Log => 1.0,
            ScaleKind::Linear => (0.1 * high.abs()).max(if high == 0.0 { 1.0 } else { 0.0 }),
        };
        let pad = if high - low >= length { margin * length } else { length / 2.0 };
        let (mut from, mut to) = (self.backward(low - pad), self.backward(high + pad));
        if self.scale == ScaleKind::Log {
            (from, to) = (from.max(f64::MIN_POSITIVE), to.min(f64::MAX));
        }
        let sound = self.shows(from) && self.shows(to) && from < to && (to - from).is_finite();
        if sound { Ok((from, to)) } else { Err(PlotError::Range { axis: self.label.clone(), from, to }) }
    }

    fn forward(&self, value: f64) -> f64 {
        if self.scale == ScaleKind::Log { value.log10() } else { value }
    }

    fn backward(&self, value: f64) -> f64 {
        if self.scale == ScaleKind::Log { 10f64.powf(value) } else { value }
    }
}

/// An axis with its range, laid along the picture from `start` to `end`.
#[derive(Clone, Debug)]
pub(super) struct Scale<'a> {
    pub(super) axis: &'a Axis,
    pub(super) range: (f64, f64),
    pub(super) start: f64,
    pub(super) end: f64,
}

impl Scale<'_> {
    /// Where a value lies, also outside the range (at most 100 lengths away); `None` if it cannot be shown.
    pub(super) fn at(&self, value: f64) -> Option<f64> {
        if !self.axis.shows(value) {
            return None;
        }
        let (from, to) = (self.axis.forward(self.range.0), self.axis.forward(self.range.1));
        let share = ((self.axis.forward(value) - from) / (to - from)).clamp(-100.0, 100.0);
        Some(self.start + share * (self.end - self.start))
    }

    /// Ticks about `spacing` apart, ascending.
    pub(super) fn ticks(&self, spacing: f64) -> Vec<Tick> {
        let wanted = ((self.end - self.start).abs() / spacing).max(2.0);
        match self.axis.scale {
            ScaleKind::Linear => linear_ticks(self.range, wanted),
            ScaleKind::Log => log_ticks(self.range, wanted),
        }
    }
}

/// The number at a tick.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum TickLabel {
    /// No number: a short tick.
    None,
    /// As it is.
    Plain(String),
    /// Mantissa × 10^exponent; an empty mantissa is 1.
    Power(String, i32),
}

/// A tick.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) label: TickLabel,
}

/// 1, 2 or 5 times a power of ten apart.
fn linear_ticks((from, to): (f64, f64), wanted: f64) -> Vec<Tick> {
    let rough = (to - from) / wanted;
    let power = rough.log10().floor();
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * 10f64.powf(power)).find(|&s| s >= rough * 0.999);
    let step = step.unwrap_or(rough);
    let (first, last) = ((from / step - 1e-9).ceil(), (to / step + 1e-9).floor());
    let size = from.abs().max(to.abs());
    let exponent = size.log10().floor();
    let places = |value: f64| (-value.log10().floor()).clamp(0.0, 12.0) as usize;
    let mut ticks = Vec::new();
    let mut k = first;
    while k <= last && ticks.len() < 100 {
        let value = k * step;
        let label = if value == 0.0 {
            TickLabel::Plain("0".into())
        } else if (1e-3..1e5).contains(&size) {
            TickLabel::Plain(minus(format!("{value:.*}", places(step * 1.000_001))))
        } else {
            let unit = 10f64.powf(exponent);
            TickLabel::Power(minus(format!("{:.*}", places(step / unit * 1.000_001), value / unit)), exponent as i32)
        };
        ticks.push(Tick { value, label });
        k += 1.0;
    }
    ticks
}

/// Decades, every n-th numbered; 1-2-5 where there are fewer than two decades; short ticks between
/// decades where there is room.
fn log_ticks((from, to): (f64, f64), wanted: f64) -> Vec<Tick> {
    let decades = to.log10() - from.log10();
    if decades < 0.3 {
        return linear_ticks((from, to), wanted);
    }
    let (first, last) = (from.log10().floor() as i32, to.log10().ceil() as i32);
    let every = (decades / wanted).ceil().max(1.0) as i32;
    let plain = from >= 1e-3 && to <= 2e5;
    let number = |m: f64, e: i32| match (plain, m == 1.0) {
        (true, _) => TickLabel::Plain(format!("{:.*}", (-e).max(0) as usize, m * 10f64.powi(e))),
        (false, true) => TickLabel::Power(String::new(), e),
        (false, false) => TickLabel::Power(format!("{m:.0}"), e),
    };
    let mut ticks = Vec::new();
    for e in first..=last {
        for m in 1..10 {
            let value = f64::from(m) * 10f64.powi(e);
            if value < from * (1.0 - 1e-9) || value > to * (1.0 + 1e-9) {
                continue;
            }
            let label = match m {
                1 if e.rem_euclid(every) == 0 => number(1.0, e),
                2 | 5 if decades < 2.0 => number(f64::from(m), e),
                1 => TickLabel::None,
                _ if every == 1 && decades <= 8.0 => TickLabel::None,
                _ => continue,
            };
            ticks.push(Tick { value, label });
        }
    }
    ticks
}

/// The typographic minus sign, as long as a plus.
pub(super) fn minus(text: String) -> String {
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &[Tick]) -> Vec<String> {
        let text = |t: &Tick| match &t.label {
            TickLabel::None => None,
            TickLabel::Plain(p) => Some(p.clone()),
            TickLabel::Power(m, e) => Some(format!("{m}e{e}")),
        };
        ticks.iter().filter_map(text).collect()
    }

    #[test]
    fn linear_ticks_are_round() {
        assert_eq!(labels(&linear_ticks((-160.0, 131.0), 6.0)), ["−150", "−100", "−50", "0", "50", "100"]);
        assert_eq!(labels(&linear_ticks((0.0, 1.5), 6.0)), ["0.0", "0.5", "1.0", "1.5"].map(|t| t.replace("0.0", "0")));
        assert_eq!(labels(&linear_ticks((0.0, 3e-6), 3.0)), ["0", "1e-6", "2e-6", "3e-6"]);
        assert_eq!(labels(&linear_ticks((1e6, 1.2e6), 2.0)), ["1.0e6", "1.1e6", "1.2e6"]);
    }

    #[test]
    fn log_ticks_are_decades() {
        assert_eq!(labels(&log_ticks((1e-10, 1e-3), 8.0)).len(), 8);
        assert_eq!(labels(&log_ticks((20.0, 30_000.0), 8.0)), ["100", "1000", "10000"]);
        assert_eq!(labels(&log_ticks((1e-30, 1.0), 6.0)), ["e-30", "e-25", "e-20", "e-15", "e-10", "e-5", "e0"]);
        assert_eq!(labels(&log_ticks((3.0, 60.0), 8.0)), ["5", "10", "20", "50"]);
    }

    #[test]
    fn ranges_fit_any_data() {
        let nothing = || PlotError::Nothing { title: String::new(), axis: "x" };
        let fit = |axis: &Axis, v: &[f64]| axis.range_for(v.iter().copied(), 0.0, nothing);
        let (linear, log) = (Axis::linear("a"), Axis::log("b"));
        assert_eq!(fit(&linear, &[f64::NAN, 1.0, 3.0]), Ok((1.0, 3.0)));
        assert_eq!(fit(&linear, &[0.0, 0.0]), Ok((-0.5, 0.5)));
        assert!(fit(&linear, &[5.0]).is_ok_and(|(a, b)| a < 5.0 && b > 5.0));
        assert!(fit(&log, &[1e-4]).is_ok_and(|(a, b)| a < 1e-4 && b > 1e-4));
        assert_eq!(fit(&log, &[0.0, -1.0, f64::INFINITY]), Err(nothing()));
        assert!(matches!(fit(&linear, &[f64::MAX, -f64::MAX]), Err(PlotError::Range { .. })));
        let given = Axis { range: Some((2.0, 1.0)), ..Axis::linear("c") };
        assert!(matches!(fit(&given, &[1.0]), Err(PlotError::Range { .. })));
    }
}
