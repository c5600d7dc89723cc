//! The safety filter that ends every law.
