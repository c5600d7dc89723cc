//! Turns obstacles into apparent obstacles.
