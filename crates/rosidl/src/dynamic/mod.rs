//! Decoding types that are known only at run time.
