//! The camera's core on folders and bags that the tests write.

#![expect(clippy::unwrap_used, reason = "a test may panic, its helpers too")]

mod bag;
mod common;
mod folder;
mod localized;
