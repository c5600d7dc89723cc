//! Control laws of chapters 3 to 7.
