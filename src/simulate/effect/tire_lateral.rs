//! Tyre, sideways: T = −sign(v_y)·min(C₁ β, μ N), β = atan2(|v_y|, |v_x| + v_reg) (eq. (28) of Xue
//! et al. 2014; friction cap and regularisation speed are ours). Smooth through v_y = 0, where it
//! acts as a damper C₁/v_reg. Dissipates |T v_y|.

pub(super) const NAME: &str = "tire-lateral";

/// The law's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::simulate) struct TireLateral {
    /// C₁, N/rad.
    pub(in crate::simulate) cornering_stiffness: f64,
    /// μ.
    pub(in crate::simulate) friction: f64,
    /// |v_x| + v_reg, m/s.
    pub(in crate::simulate) base_speed: f64,
}

impl TireLateral {
    /// Force along +y and its derivatives by sideways speed and by normal force: (N, N·s/m, 1).
    pub(in crate::simulate) fn force(self, sideways: f64, normal: f64) -> (f64, f64, f64) {
        let angle = sideways.abs().atan2(self.base_speed);
        let elastic = self.cornering_stiffness * angle;
        let cap = self.friction * normal.max(0.0);
        let direction = if sideways < 0.0 { 1.0 } else { -1.0 };
        if elastic <= cap {
            // d atan(v/b)/dv = b/(v² + b²).
            let slope = self.cornering_stiffness * self.base_speed / (sideways * sideways + self.base_speed.powi(2));
            (direction * elastic, -slope, 0.0)
        } else {
            let by_normal = if normal > 0.0 { direction * self.friction } else { 0.0 };
            (direction * cap, 0.0, by_normal)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opposes_slip_is_capped_and_has_the_stated_derivatives() {
        let law = TireLateral { cornering_stiffness: 9542.6, friction: 0.743, base_speed: 12.6 };
        let (f, _, _) = law.force(1.0, 1e6);
        assert!((f + 9542.6 * (1.0f64 / 12.6).atan()).abs() < 1e-9);
        assert_eq!(law.force(5.0, 1000.0).0, -743.0);
        assert_eq!(law.force(-5.0, 1000.0).0, 743.0);
        assert_eq!(law.force(0.0, 1000.0).0, 0.0);
        for (v, n) in [(0.3, 1e5), (-0.7, 1e5), (4.0, 900.0), (-4.0, 900.0)] {
            let h = 1e-5;
            let (_, dv, dn) = law.force(v, n);
            let by_speed = (law.force(v + h, n).0 - law.force(v - h, n).0) / (2.0 * h);
            let by_normal = (law.force(v, n + h).0 - law.force(v, n - h).0) / (2.0 * h);
            // Central differences of step 1e-5 carry 1e-10·f''' plus ε·f/h ≈ 2e-7.
            assert!((dv - by_speed).abs() < 1e-5 && (dn - by_normal).abs() < 1e-5, "v = {v}");
        }
    }
}
