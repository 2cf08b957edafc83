//! Integrators: order, stability limit, step.

mod block;
mod exact;

pub(super) use exact::{Counts, Exact, Sample};

/// What an integrator promises.
#[derive(Clone, Copy, Debug)]
pub struct IntegratorInfo {
    /// Name.
    pub name: &'static str,
    /// Order of convergence with contact.
    pub order: u32,
    /// One line.
    pub help: &'static str,
}

/// All integrators.
pub const INTEGRATORS: &[IntegratorInfo] = &[IntegratorInfo {
    name: "exact-modal",
    order: 2,
    help: "linear part by matrix exponential, contact forces linear over the step and solved implicitly, touchdown and lift-off located; no step limit in the linear part",
}];
