//! The recorder's process: a node like the others, for launch files and for `trench bag record`.

fn main() -> std::process::ExitCode {
    trench_runtime::wait_turn(trench_runtime::Turn::Watcher);
    trench_runtime::run_without_journal(trench_bag::recorder::description())
}
