//! Zenoh's own configuration: peers without a router, clients behind one, TLS, access control.

use crate::common::{Island, Running};
use std::path::Path;
use std::process::Command;

impl Island {
    /// Where the router listens.
    pub(crate) fn router(&self) -> &str {
        self.router.as_ref().map_or("", |(_, locator)| locator)
    }

    /// An endpoint of this host that nobody listens on.
    pub(crate) fn endpoint(&self, protocol: &str) -> String {
        let free = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        format!("{protocol}/127.0.0.1:{}", free.port())
    }
}

/// Starts an example with further assignments to Zenoh's configuration.
fn start_with(island: &Island, example: &str, overrides: &str) -> Running {
    let mut command = island.command(example, "--ros-args -p local:=network -p rate:=50.0");
    if example == "listener" {
        command = island.command(example, "");
    }
    command.env("RMW_IMPLEMENTATION", "rmw_zenoh_cpp").env("ZENOH_CONFIG_OVERRIDE", overrides);
    Island::run(command)
}

#[test]
fn peers_find_each_other_without_a_router() {
    let island = Island::new(16);
    let at = island.endpoint("tcp");
    let listener = start_with(&island, "listener", &format!("listen/endpoints=[\"{at}\"];connect/endpoints=[]"));
    let _talker = start_with(&island, "talker", &format!("connect/endpoints=[\"{at}\"]"));
    listener.line();
}

#[test]
fn clients_talk_through_the_router() {
    let island = Island::with_router(17);
    let client = format!("mode=\"client\";connect/endpoints=[\"{}\"];listen/endpoints=[]", island.router());
    let listener = start_with(&island, "listener", &client);
    let _talker = start_with(&island, "talker", &client);
    listener.line();
}

#[test]
fn peers_go_on_without_the_router_that_introduced_them() {
    let mut island = Island::with_router(44);
    let listener = island.start("listener", "");
    let talker = island.start("talker", "--ros-args -p local:=network -p rate:=50.0");
    let count = |line: String| line.split(' ').next().unwrap().parse::<u64>().unwrap();
    let mut last = count(listener.line());
    let (router, _) = island.router.take().unwrap();
    router.signal("KILL");
    router.end();
    for _ in 0..150 {
        let next = count(listener.line());
        assert_eq!(next, last + 1);
        last = next;
    }
    drop(talker);
}

#[test]
fn tls_keeps_out_who_has_no_certificate() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["ours", "foreign"] {
        certificate(folder.path(), name);
    }
    let file = |name: &str| folder.path().join(name).display().to_string();
    let island = Island::new(18);
    let at = island.endpoint("tls");
    let tls = |name: &str| {
        format!(
            "transport/link/tls={{root_ca_certificate:\"{}\",listen_private_key:\"{}\",listen_certificate:\"{}\",\
             connect_private_key:\"{}\",connect_certificate:\"{}\",enable_mtls:true}}",
            file("ours-authority.crt"),
            file(&format!("{name}.key")),
            file(&format!("{name}.crt")),
            file(&format!("{name}.key")),
            file(&format!("{name}.crt")),
        )
    };
    let listening = format!("listen/endpoints=[\"{at}\"];connect/endpoints=[];{}", tls("ours"));
    let listener = start_with(&island, "listener", &listening);
    let connecting = |name: &str| format!("connect/endpoints=[\"{at}\"];{}", tls(name));
    let foreign = start_with(&island, "talker", &connecting("foreign"));
    let talker = start_with(&island, "talker", &connecting("ours"));
    let first = listener.line();
    foreign.signal("INT");
    foreign.end();
    // The counts of one writer: the foreign one would have counted, too.
    let count = |line: &str| line.split(' ').next().unwrap().parse::<u64>().unwrap();
    let mut last = count(&first);
    for _ in 0..50 {
        let next = count(&listener.line());
        assert_eq!(next, last + 1);
        last = next;
    }
    drop(talker);
}

/// A certificate for this host, of an authority of its own.
fn certificate(folder: &Path, name: &str) {
    let authority = format!("{name}-authority");
    openssl(folder, &authority, &["-subj", &format!("/CN={authority}")]);
    let file = |ending: &str| folder.join(format!("{authority}.{ending}")).display().to_string();
    let leaf = ["-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1"];
    let signed = ["-addext", "basicConstraints=critical,CA:FALSE", "-CA", &file("crt"), "-CAkey", &file("key")];
    openssl(folder, name, &[leaf.as_slice(), &signed].concat());
}

fn openssl(folder: &Path, name: &str, arguments: &[&str]) {
    let made = Command::new("openssl")
        .args(["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2"])
        .args(arguments)
        .arg("-keyout")
        .arg(folder.join(format!("{name}.key")))
        .arg("-out")
        .arg(folder.join(format!("{name}.crt")))
        .output()
        .unwrap();
    assert!(made.status.success(), "openssl: {}", String::from_utf8_lossy(&made.stderr));
}

#[test]
fn access_control_decides_who_may_say_what() {
    // The router lets everything pass but what is published on /chatter.
    let rules = "access_control={enabled:true,default_permission:\"allow\",\
        rules:[{id:\"mute\",messages:[\"put\"],flows:[\"ingress\"],permission:\"deny\",key_exprs:[\"*/chatter/**\"]}],\
        subjects:[{id:\"all\"}],policies:[{rules:[\"mute\"],subjects:[\"all\"]}]}";
    let island = Island::with_router_of(19, rules);
    let client = format!("mode=\"client\";connect/endpoints=[\"{}\"];listen/endpoints=[]", island.router());
    let muted = start_with(&island, "listener", &client);
    let remapped = {
        let mut command = island.command("listener", "--ros-args -r /chatter:=/allowed -r __node:=other");
        command.env("RMW_IMPLEMENTATION", "rmw_zenoh_cpp").env("ZENOH_CONFIG_OVERRIDE", &client);
        Island::run(command)
    };
    let _talker = start_with(&island, "talker", &client);
    let mut command =
        island.command("talker", "--ros-args -p rate:=50.0 -p local:=network -r /chatter:=/allowed -r __node:=free");
    command.env("RMW_IMPLEMENTATION", "rmw_zenoh_cpp").env("ZENOH_CONFIG_OVERRIDE", &client);
    let _free = Island::run(command);
    for _ in 0..100 {
        remapped.line();
    }
    muted.signal("INT");
    let (_, lines, said) = muted.end();
    assert_eq!(lines, Vec::<String>::new());
    assert!(said.iter().any(|line| line.contains("1 writer(s)")), "it saw the writer that it may not hear: {said:?}");
}

#[test]
fn wrong_configurations_end_a_node_and_say_where() {
    let check = |variable: &str, value: &str, expected: &str, code: i32| {
        let mut command = Island::new(19).command("talker", "");
        command.env("RMW_IMPLEMENTATION", "rmw_zenoh_cpp").env(variable, value);
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert!(said.contains(expected), "{said}");
    };
    check("ZENOH_SESSION_CONFIG_URI", "/no/such.json5", "ZENOH_SESSION_CONFIG_URI: /no/such.json5", 4);
    check("ZENOH_CONFIG_OVERRIDE", "mode", "ZENOH_CONFIG_OVERRIDE: `mode`: write key=value", 4);
    check("ROS_SECURITY_ENABLE", "true", "Zenoh does not go by it", 2);
    check("RMW_IMPLEMENTATION", "rmw_carrier_pigeon", "RMW_IMPLEMENTATION is `rmw_carrier_pigeon`", 2);
}
