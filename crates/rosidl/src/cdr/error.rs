//! Why bytes are not a message.

/// Why bytes are not the message they should be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CdrError {
    /// The bytes end before the field does.
    #[error("the message ends at byte {length}, {needed} more are needed for {field}")]
    Short {
        /// Where the bytes end.
        length: usize,
        /// How many are missing, at least.
        needed: usize,
        /// The field being read.
        field: &'static str,
    },
    /// The first two bytes name an encapsulation other than CDR.
    #[error("the encapsulation {0:#06x} is neither 0x0000 (CDR big endian) nor 0x0001 (CDR little endian)")]
    Encapsulation(u16),
    /// A string is not UTF-8 or lacks its terminating zero.
    #[error("{0} is not a UTF-8 string with a terminating zero")]
    String(&'static str),
    /// A boolean is neither 0 nor 1.
    #[error("{0} is a boolean, but neither 0 nor 1")]
    Bool(&'static str),
    /// A bounded string or sequence is too long.
    #[error("{field} holds {length} elements, its bound is {bound}")]
    Bound {
        /// The field being read.
        field: &'static str,
        /// What the bytes say.
        length: usize,
        /// What the type allows.
        bound: usize,
    },
}
