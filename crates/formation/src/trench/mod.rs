//! Potential trench functions of 5.2 and A.9.
