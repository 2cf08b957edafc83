//! Given forces: constant F; half-sine F sin(πt/T) for 0 ≤ t ≤ T; table, straight between its points
//! and zero outside. Its work is input energy.

pub(super) const NAME: &str = "applied-force";

/// A force over time, N.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::simulate) enum AppliedForce {
    /// One value per load case; a transient takes the first.
    Constant(Vec<f64>),
    /// Peak, N, and duration, s.
    HalfSine {
        /// N.
        peak: f64,
        /// s.
        duration: f64,
    },
    /// (s, N), times ascending.
    Table(Vec<(f64, f64)>),
}

impl AppliedForce {
    /// N at time t, s.
    pub(in crate::simulate) fn at(&self, t: f64) -> f64 {
        match self {
            Self::Constant(values) => values.first().copied().unwrap_or(0.0),
            Self::HalfSine { peak, duration } => {
                if (0.0..=*duration).contains(&t) {
                    peak * (std::f64::consts::PI * t / duration).sin()
                } else {
                    0.0
                }
            }
            Self::Table(points) => {
                let after = points.partition_point(|p| p.0 < t);
                match (after.checked_sub(1).map(|k| points[k]), points.get(after)) {
                    (Some((t0, f0)), Some(&(t1, f1))) => f0 + (f1 - f0) * (t - t0) / (t1 - t0),
                    (None, Some(&(t1, f1))) if t1 == t => f1,
                    _ => 0.0,
                }
            }
        }
    }

    /// Slope at time t (to the left of a corner), N/s.
    pub(in crate::simulate) fn slope(&self, t: f64) -> f64 {
        match self {
            Self::Constant(_) => 0.0,
            Self::HalfSine { peak, duration } => {
                let rate = std::f64::consts::PI / duration;
                if (0.0..=*duration).contains(&t) { peak * rate * (rate * t).cos() } else { 0.0 }
            }
            Self::Table(points) => {
                let after = points.partition_point(|p| p.0 < t);
                match (after.checked_sub(1).map(|k| points[k]), points.get(after)) {
                    (Some((t0, f0)), Some(&(t1, f1))) => (f1 - f0) / (t1 - t0),
                    _ => 0.0,
                }
            }
        }
    }

    /// N in a load case of a static analysis.
    pub(in crate::simulate) fn in_case(&self, case: usize) -> f64 {
        match self {
            Self::Constant(values) if values.len() == 1 => values[0],
            Self::Constant(values) => values.get(case).copied().unwrap_or(0.0),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_three_laws() {
        let table = AppliedForce::Table(vec![(0.0, 0.0), (1.0, 4.0), (2.0, 0.0)]);
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0].map(|t| table.at(t)), [0.0, 0.0, 2.0, 4.0, 2.0, 0.0, 0.0]);
        let pulse = AppliedForce::HalfSine { peak: 500.0, duration: 0.01 };
        assert_eq!((pulse.at(0.005), pulse.at(0.011)), (500.0, 0.0));
        assert_eq!(AppliedForce::Constant(vec![1.0, 2.0]).in_case(1), 2.0);
    }
}
