//! ROS 2 interface definitions: parse .msg and .srv text, compute RIHS01 type hashes, generate Rust.
