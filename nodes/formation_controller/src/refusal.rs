//! Messages that do not count.

/// Why one does not count.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(crate) enum Refusal {
    /// Late: a newer one has been heard.
    #[error("it is {0:.3} s older than one heard before")]
    Past(f64),
    /// From the future.
    #[error("it is {0:.3} s from the future")]
    Future(f64),
    /// Of another assignment.
    #[error("it is of epoch {theirs}, ours is {ours}")]
    Epoch {
        /// The message's.
        theirs: u64,
        /// The assignment's.
        ours: u64,
    },
    /// Of another formation.
    #[error("it is of another formation")]
    Formation,
    /// A number that is none.
    #[error("a number in it is not finite")]
    NotFinite,
}

impl Refusal {
    /// Whether who says so is there all the same, and merely late or of another order: a master stays one.
    pub(crate) const fn is_late(self) -> bool {
        matches!(self, Self::Past(_) | Self::Epoch { .. } | Self::Formation)
    }
}
