//! Hosts of a test: network namespaces with bridges between them. They share the kernel's clock and its files, and nothing
//! of the network.

use std::ffi::OsStr;
use std::process::{Command, Stdio};

/// Networks and hosts, which vanish with this.
pub(crate) struct World {
    name: String,
    namespaces: Vec<String>,
}

/// A host's place in a world.
pub(crate) struct Host {
    namespace: String,
}

impl World {
    /// Nothing yet; the reason where this machine or user may not have namespaces.
    pub(crate) fn new(number: u16) -> Result<Self, String> {
        let mut world = Self { name: format!("tr{}n{number}", std::process::id()), namespaces: Vec::new() };
        let probe = world.namespace("probe")?;
        ip(&["-n", &probe, "link", "set", "lo", "up"])?;
        Ok(world)
    }

    fn namespace(&mut self, name: &str) -> Result<String, String> {
        let namespace = format!("{}{name}", self.name);
        ip(&["netns", "add", &namespace])?;
        self.namespaces.push(namespace.clone());
        Ok(namespace)
    }

    /// A network: a switch that floods multicast.
    pub(crate) fn network(&mut self, name: &str) -> String {
        let namespace = self.namespace(name).unwrap();
        ip(&["-n", &namespace, "link", "add", "bridge", "type", "bridge", "mcast_snooping", "0"]).unwrap();
        ip(&["-n", &namespace, "link", "set", "bridge", "up"]).unwrap();
        namespace
    }

    /// A host on these networks, with an address (and its length) in each.
    pub(crate) fn host(&mut self, name: &str, legs: &[(&str, &str)]) -> Host {
        let namespace = self.namespace(name).unwrap();
        ip(&["-n", &namespace, "link", "set", "lo", "up"]).unwrap();
        for (number, (network, address)) in legs.iter().enumerate() {
            // The network's end is named after the host; both names have room for 15 letters.
            let (here, there) = (format!("eth{number}"), format!("to-{name}"));
            let pair =
                ["-n", &namespace, "link", "add", &here, "type", "veth", "peer", "name", &there, "netns", network];
            ip(&pair).unwrap();
            ip(&["-n", network, "link", "set", &there, "master", "bridge", "up"]).unwrap();
            ip(&["-n", &namespace, "addr", "add", address, "dev", &here]).unwrap();
            ip(&["-n", &namespace, "link", "set", &here, "up"]).unwrap();
            if number == 0 {
                // DDS speaks to its multicast group on the way to everywhere.
                ip(&["-n", &namespace, "route", "add", "default", "dev", &here]).unwrap();
            }
        }
        Host { namespace }
    }
}

impl Host {
    /// A command on this host instead of here, its variables kept.
    pub(crate) fn move_to(&self, command: &Command) -> Command {
        let mut moved = self.command(command.get_program());
        moved.args(command.get_args());
        for (name, value) in command.get_envs() {
            match value {
                Some(value) => moved.env(name, value),
                None => moved.env_remove(name),
            };
        }
        moved
    }

    /// A program on this host.
    fn command(&self, program: &OsStr) -> Command {
        let mut command = Command::new("ip");
        command.args(["netns", "exec", &self.namespace]).arg(program);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Its name among all hosts of this machine.
    pub(crate) fn name(&self) -> &str {
        &self.namespace
    }

    /// Whether it can send to `address` at all.
    pub(crate) fn reaches(&self, address: &str) -> bool {
        let probe = format!("exec 3<>/dev/tcp/{address}/9");
        self.command("bash".as_ref()).args(["-c", &probe]).output().is_ok_and(|output| {
            // Somebody who says that nothing listens there can be reached.
            output.status.success() || String::from_utf8_lossy(&output.stderr).contains("refused")
        })
    }
}

impl Drop for World {
    fn drop(&mut self) {
        for namespace in &self.namespaces {
            if let Err(error) = ip(&["netns", "del", namespace]) {
                println!("a network namespace stays behind: {error}");
            }
        }
    }
}

fn ip(arguments: &[&str]) -> Result<(), String> {
    let output = Command::new("ip").args(arguments).output().map_err(|error| format!("ip: {error}"))?;
    let said = String::from_utf8_lossy(&output.stderr);
    if output.status.success() { Ok(()) } else { Err(format!("ip {}: {}", arguments.join(" "), said.trim())) }
}
