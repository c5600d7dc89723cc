//! Assignment of robots to queues and places.
