//! The square with the base station and each robot's controller on hosts of their own (network namespaces): by DDS over one
//! bridge, and by Zenoh through a router between two networks that nothing else crosses.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod live_support;
#[path = "../crates/runtime/tests/hosts/network.rs"]
mod network;
#[path = "live_support/tuned.rs"]
mod tuned;

use live_support::{Launch, domain};
use network::{Host, World};
use rustix::process::{Pid, Signal, kill_process};
use std::process::{Child, Command, Stdio};

const ROBOTS: [&str; 4] = ["robot1", "robot2", "robot3", "robot4"];

/// What runs on another host until the test is over.
struct Elsewhere(Child);

impl Elsewhere {
    fn start(host: &Host, command: &Command) -> Self {
        let mut moved = host.move_to(command);
        // Nobody reads along; a launcher keeps its log in its run folder.
        Self(moved.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap())
    }
}

impl Drop for Elsewhere {
    fn drop(&mut self) {
        kill_process(Pid::from_child(&self.0), Signal::INT).unwrap();
        self.0.wait().unwrap();
    }
}

/// A world of hosts; nothing, with the reason printed, where this user may not make one.
fn world(number: u16) -> Option<World> {
    World::new(number).map_err(|problem| println!("SKIPPED: no network namespaces here: {problem}")).ok()
}

/// Runs the square with these hosts and holds its bag against the bounds of the square on one host. `variables` are those
/// of a host by its number, the base station first.
fn the_square_stands(launch: &Launch, hosts: &[Host], variables: impl Fn(usize) -> Vec<(&'static str, String)>) {
    let with = |mut command: Command, host: usize| {
        command.envs(variables(host));
        command
    };
    let controllers: Vec<Elsewhere> = ROBOTS
        .iter()
        .zip(1..)
        .map(|(robot, host)| {
            let mut command = with(launch.command("robot_host.launch.yaml", hosts[host].name()), host);
            command.arg(format!("robot:={robot}")).arg(format!("robots:=[{}]", ROBOTS.join(", ")));
            Elsewhere::start(&hosts[host], &command)
        })
        .collect();
    let base = with(launch.recording("square.launch.yaml", &["controllers:=false", "duration:=30.0"]), 0);
    let (status, text) = launch.finish(hosts[0].move_to(&base));
    assert!(status.success(), "{status}\n{text}");
    drop(controllers);
    hosts.iter().for_each(|host| launch.forget(host.name()));
    tuned::keeps_its_bounds(&launch.judge(&[]));
}

#[test]
fn live_square_on_five_hosts() {
    let Some(mut world) = world(60) else { return };
    let bridge = world.network("net");
    let address = |number: usize| format!("10.77.0.{}/24", number + 1);
    let names = ["base"].into_iter().chain(ROBOTS).enumerate();
    let hosts: Vec<Host> = names.map(|(number, name)| world.host(name, &[(&bridge, &address(number))])).collect();
    the_square_stands(&Launch::new(domain(0)), &hosts, |_| Vec::new());
}

#[test]
fn live_square_on_two_networks_over_zenoh() {
    let Some(mut world) = world(61) else { return };
    let (one, other) = (world.network("one"), world.network("other"));
    let gate = world.host("gate", &[(&one, "10.78.0.254/24"), (&other, "10.79.0.254/24")]);
    let address = |number: usize| format!("10.79.0.{number}/24");
    let robots = ROBOTS.into_iter().zip(1..);
    let mut hosts = vec![world.host("base", &[(&one, "10.78.0.1/24")])];
    hosts.extend(robots.map(|(name, number)| world.host(name, &[(&other, &address(number))])));
    assert!(hosts[0].reaches("10.78.0.254"), "the networks do not work");
    assert!(!hosts[0].reaches("10.79.0.1"), "the networks are joined: the router proves nothing");
    let launch = Launch::new(domain(1));
    let _router = Elsewhere::start(&gate, &launch.command("router.launch.yaml", "gate"));
    the_square_stands(&launch, &hosts, |host| {
        let gate = if host == 0 { "10.78.0.254" } else { "10.79.0.254" };
        let session = format!("mode=\"client\";listen/endpoints=[];connect/endpoints=[\"tcp/{gate}:7447\"]");
        vec![("RMW_IMPLEMENTATION", "rmw_zenoh_cpp".to_owned()), ("ZENOH_CONFIG_OVERRIDE", session)]
    });
}
