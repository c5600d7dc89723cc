//! Drives one robot to its place in the formation.
