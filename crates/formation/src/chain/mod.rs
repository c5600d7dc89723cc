//! Chains of 6.2.1.
