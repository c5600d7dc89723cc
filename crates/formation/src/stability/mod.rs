//! Stable zone, closed forms of chapter 4, Lyapunov functions, input-to-state bounds.
