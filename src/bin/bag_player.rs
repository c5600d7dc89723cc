//! The player's process: a node like the others, for launch files and for `trench bag play`.

fn main() -> std::process::ExitCode {
    trench_runtime::run_without_journal(trench_bag::player::description())
}
