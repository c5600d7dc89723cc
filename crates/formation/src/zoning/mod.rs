//! Zoning potentials of chapter 6.
