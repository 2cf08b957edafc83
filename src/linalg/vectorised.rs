//! Kernels compiled for the widest vector instructions the machine has.

use pulp::{Arch, Simd, WithSimd};

/// A kernel written with plain loops; `FMA` says whether `f64::mul_add` is one instruction.
pub(super) trait Kernel {
    /// What it returns.
    type Output;
    /// The loops; must be `#[inline(always)]` to be compiled for the chosen instructions.
    fn run<const FMA: bool>(self) -> Self::Output;
}

struct Dispatch<K>(K);

impl<K: Kernel> WithSimd for Dispatch<K> {
    type Output = K::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> K::Output {
        if S::IS_SCALAR { self.0.run::<false>() } else { self.0.run::<true>() }
    }
}

/// Runs a kernel on the instructions chosen at run time.
pub(super) fn vectorised<K: Kernel>(kernel: K) -> K::Output {
    Arch::new().dispatch(Dispatch(kernel))
}

/// a·b + c.
#[inline(always)]
pub(super) fn fma<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}
