//! Assigns robots to queues, orders teams into chains, publishes goals and the run state.
