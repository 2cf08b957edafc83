//! Tyre, vertical: N = K τ + C τ̇ while pressed, never pulling (eq. (27) of Xue et al. 2014).
//! Stores ½ K τ², dissipates C τ̇² while pressed; what the spring still holds when the tyre leaves
//! the ground is dissipated as it relaxes.

pub(super) const NAME: &str = "tire-normal";

/// The law's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::simulate) struct TireNormal {
    /// K, N/m.
    pub(in crate::simulate) stiffness: f64,
    /// C, N·s/m.
    pub(in crate::simulate) damping: f64,
}

impl TireNormal {
    /// K τ + C τ̇ without the one-sidedness, N; penetration τ in m, rate in m/s.
    pub(in crate::simulate) fn pressed(self, penetration: f64, rate: f64) -> f64 {
        self.stiffness * penetration + self.damping * rate
    }

    /// The force, N: `pressed` where the tyre touches and pushes, else 0.
    pub(in crate::simulate) fn force(self, penetration: f64, rate: f64) -> f64 {
        if penetration >= 0.0 { self.pressed(penetration, rate).max(0.0) } else { 0.0 }
    }

    /// ½ K τ², J.
    pub(in crate::simulate) fn stored(self, penetration: f64) -> f64 {
        0.5 * self.stiffness * penetration.max(0.0).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pushes_and_never_pulls() {
        let law = TireNormal { stiffness: 75_000.0, damping: 175.0 };
        assert_eq!(law.force(0.01, 1.0), 925.0);
        assert_eq!(law.force(0.01, -10.0), 0.0);
        assert_eq!(law.force(-0.01, 100.0), 0.0);
        assert_eq!(law.force(0.0, 3.0), 525.0);
        assert_eq!((law.stored(0.02), law.stored(-0.02)), (15.0, 0.0));
    }
}
