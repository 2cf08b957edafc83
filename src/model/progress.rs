//! How long work tells what it is doing, without knowing who listens.

/// Receives progress; called from the thread that works.
pub trait Progress: Sync {
    /// `done` of `total` units of the named stage are finished; `total` = 0 when it is not known.
    fn report(&self, stage: &str, done: usize, total: usize);
}

/// Nobody listens.
#[derive(Clone, Copy, Debug)]
pub struct Silent;

impl Progress for Silent {
    fn report(&self, _stage: &str, _done: usize, _total: usize) {}
}
