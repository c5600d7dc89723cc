//! Zenoh's own configuration, from where rmw_zenoh takes it.

use std::env;
use zenoh::Config;

/// A session as rmw_zenoh opens it by default: a peer that listens to this host alone, finds the others through the
/// router of this host, and asks nobody by multicast. Time stamps are what the cache of latched topics sorts by. Deeper
/// queues than Zenoh's own: what finds no room in them for 1 ms is dropped. Where rmw_zenoh differs: a client waits for its
/// router for a while, and whoever lost the router looks for it every fifth of a second at first, not every second.
const SESSION: &str = r#"{
    mode: "peer",
    connect: {
        endpoints: ["tcp/localhost:7447"],
        timeout_ms: { router: -1, peer: -1, client: 8000 },
        exit_on_failure: { router: false, peer: false, client: true },
        retry: { period_init_ms: 200, period_max_ms: 1000, period_increase_factor: 1.5 },
    },
    listen: { endpoints: ["tcp/localhost:0"] },
    scouting: {
        multicast: { enabled: false },
        gossip: {
            target: { router: ["router", "peer"], peer: ["router"] },
            autoconnect_strategy: { peer: { to_router: "always", to_peer: "greater-zid" } },
        },
    },
    timestamping: { enabled: { router: true, peer: true, client: true } },
    queries_default_timeout: 600000,
    transport: {
        unicast: { open_timeout: 60000, accept_timeout: 60000, accept_pending: 10000, max_sessions: 10000 },
        link: { tx: { queue: { size: { data: 16, data_low: 16 } } } },
    },
}"#;

/// A router as rmw_zenoh starts it by default.
const ROUTER: &str = r#"{
    mode: "router",
    listen: { endpoints: ["tcp/[::]:7447"] },
    scouting: {
        multicast: { enabled: false },
        gossip: {
            target: { router: ["router", "peer"], peer: ["router"] },
            autoconnect_strategy: { router: { to_router: "always", to_peer: "always" } },
        },
    },
    routing: { router: { peers_failover_brokering: false } },
    timestamping: { enabled: { router: true, peer: true, client: true } },
    queries_default_timeout: 600000,
    transport: {
        unicast: { open_timeout: 60000, accept_timeout: 60000, accept_pending: 10000, max_sessions: 10000 },
        link: { tx: { queue: { size: { data: 16, data_low: 16 } } } },
    },
}"#;

/// The configuration of a session; what is wrong with it, and where, if it cannot be used.
pub(super) fn session() -> Result<Config, String> {
    configuration("ZENOH_SESSION_CONFIG_URI", SESSION, |name| env::var(name).ok())
}

/// The same of a router.
pub(super) fn router() -> Result<Config, String> {
    configuration("ZENOH_ROUTER_CONFIG_URI", ROUTER, |name| env::var(name).ok())
}

/// The file that the variable `file` names, or `default`, with the assignments of ZENOH_CONFIG_OVERRIDE on top:
/// `key=value`, with semicolons between them.
fn configuration(file: &str, default: &str, variable: impl Fn(&str) -> Option<String>) -> Result<Config, String> {
    let mut config = match variable(file).filter(|path| !path.trim().is_empty()) {
        Some(path) => Config::from_file(path.trim()).map_err(|error| format!("{file}: {path}: {error}"))?,
        None => Config::from_json5(default).map_err(|error| format!("the default configuration: {error}"))?,
    };
    let overrides = variable("ZENOH_CONFIG_OVERRIDE").unwrap_or_default();
    for assignment in overrides.split(';').map(str::trim).filter(|text| !text.is_empty()) {
        let wrong = |problem: &str| format!("ZENOH_CONFIG_OVERRIDE: `{assignment}`: {problem}");
        let (key, value) = assignment.split_once('=').ok_or_else(|| wrong("write key=value"))?;
        config.insert_json5(key.trim(), value.trim()).map_err(|error| wrong(&error.to_string()))?;
    }
    Ok(config)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(overrides: &str) -> Result<Config, String> {
        let variable = |name: &str| (name == "ZENOH_CONFIG_OVERRIDE").then(|| overrides.to_owned());
        configuration("ZENOH_SESSION_CONFIG_URI", SESSION, variable)
    }

    #[test]
    fn the_defaults_are_valid_and_can_be_overridden() {
        assert_eq!(with("").unwrap().get_json("mode").unwrap(), "\"peer\"");
        let config = with("mode=\"client\"; connect/endpoints=[\"tcp/10.0.0.1:7447\"];").unwrap();
        assert_eq!(config.get_json("mode").unwrap(), "\"client\"");
        assert_eq!(config.get_json("connect/endpoints").unwrap(), "[\"tcp/10.0.0.1:7447\"]");
        assert!(configuration("ZENOH_ROUTER_CONFIG_URI", ROUTER, |_| None).is_ok());
    }

    #[test]
    fn wrong_configurations_say_what_and_where() {
        let check = |result: Result<Config, String>, expected: &str| {
            let error = result.unwrap_err();
            assert!(error.contains(expected), "{error}");
        };
        check(with("mode"), "ZENOH_CONFIG_OVERRIDE: `mode`: write key=value");
        check(with("mode=\"king\""), "ZENOH_CONFIG_OVERRIDE: `mode=\"king\"`");
        let missing = |name: &str| (name == "ZENOH_SESSION_CONFIG_URI").then(|| "/no/such.json5".to_owned());
        check(configuration("ZENOH_SESSION_CONFIG_URI", SESSION, missing), "ZENOH_SESSION_CONFIG_URI: /no/such.json5");
    }
}
