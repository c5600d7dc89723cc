//! The simulated test bed behind the real interfaces: camera frames out, serial bytes in.
