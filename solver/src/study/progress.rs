//! How far a long study is: told to whoever asks, printed by nobody here.

/// Somebody who is told.
pub trait Progress: Sync {
    /// Steps in all; again where more of them turn up on the way.
    fn begin(&self, steps: usize);
    /// Steps done since; none at the start of a longer stretch. It may unwind to end the work, which leaves files
    /// and journals as they are after any interruption.
    fn advance(&self, steps: usize);
    /// A longer stretch is done, and what it was.
    fn done(&self, _: &str) {}
    /// There is no more to do.
    fn end(&self);
}

/// Nobody.
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _: usize) {}
    fn advance(&self, _: usize) {}
    fn end(&self) {}
}
