//! The process of leader_assignment.

fn main() -> std::process::ExitCode {
    // Robots tick on team states, not on goals.
    trench_runtime::wait_turn(trench_runtime::Turn::Watcher);
    trench_runtime::run_alone(leader_assignment::description())
}
