//! A hundred robots whose controllers share one process, driven at 30 Hz.
//!
//! ```text
//! cargo build --release --workspace --bins && cargo bench --bench hundred
//! cargo bench --bench hundred -- robots:=50 heard:=10 seconds:=5
//! ```
//!
//! Starts `formation_controller --namespaces` for all of them, each hearing `heard` others, and is the localizer, the assignment, the
//! mapper and the robots of them all ([`world`]): poses and goals go out, commands come back and move the robots. Says how many ticks
//! each controller answered, and what the process took.

mod world;

use std::process::{Child, Command, ExitCode, Stdio};

/// A process that ends with this.
struct Controllers(Child);

impl Drop for Controllers {
    fn drop(&mut self) {
        let _has_ended = self.0.kill();
        let _has_ended = self.0.wait();
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("hundred: {error}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<u8, Box<dyn std::error::Error>> {
    let given = |name: &str, usual: &str| {
        let found =
            std::env::args().find_map(|argument| Some(argument.strip_prefix(name)?.strip_prefix(":=")?.to_owned()));
        found.unwrap_or_else(|| usual.to_owned())
    };
    let (robots, heard): (usize, usize) = (given("robots", "100").parse()?, given("heard", "20").parse()?);
    let seconds: f64 = given("seconds", "20").parse()?;
    let names = |count: usize| {
        let names: Vec<String> = (1..=count).map(|robot| format!("robot{robot}")).collect();
        format!("[{}]", names.join(", "))
    };
    // Benches are in the folder below that of the programs.
    let program =
        std::env::current_exe()?.ancestors().nth(2).ok_or("no folder of programs")?.join("formation_controller");
    let child = Command::new(program)
        .args(["--namespaces", &names(robots), "--ros-args", "-p", &format!("team:={}", names(heard.min(robots)))])
        // The floor that they stand on: outside of their field the safety filter lets nobody drive.
        .args(["-p", "law:=robust", "-p", "field:=[-5.0, -5.0, 15.0, 105.0]", "--log-level", "error"])
        .stdin(Stdio::null())
        .spawn()?;
    let controllers = Controllers(child);
    trench_runtime::wait_turn(trench_runtime::Turn::World);
    let arguments = ["--ros-args".to_owned()].into_iter().chain(
        [
            ("robots", robots.to_string()),
            ("seconds", format!("{seconds:?}")),
            ("process", controllers.0.id().to_string()),
        ]
        .into_iter()
        .flat_map(|(name, value)| ["-p".to_owned(), format!("{name}:={value}")]),
    );
    Ok(trench_runtime::run_with_arguments(world::DESCRIPTION, arguments))
}
