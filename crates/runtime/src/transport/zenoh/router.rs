//! A Zenoh router, for hosts on which nobody else runs one.

use super::configuration;
use crate::signals::Signals;
use rustdds::mio1::{Events, Poll, Token};
use std::io;
use std::time::Duration;
use zenoh::Wait;
use zenoh::internal::runtime::ZRuntime;

/// How often somebody is woken to watch connections.
const WATCH: Duration = Duration::from_millis(50);

/// Why there is no router.
#[derive(Debug, thiserror::Error)]
pub enum RouterError {
    /// Its configuration is wrong.
    #[error("{0}")]
    Configuration(String),
    /// Zenoh does not open it.
    #[error("cannot open a Zenoh router: {0}; another one may listen on the same port")]
    Open(String),
    /// The operating system refuses something.
    #[error("cannot wait for signals: {0}")]
    System(#[from] io::Error),
}

/// Sees to it that somebody watches the router's connections. Of the threads that open connections and take them (Zenoh 1.10 calls them net and acc)
/// one watches all that were made there; where it is the one that tells another router of everything that is declared, it waits for room in
/// a queue, which comes once a connection takes more, which nobody sees meanwhile: for 5 s, after which what was to be told is lost. Whoever
/// is woken for a moment finds nobody watching, and watches (there must be more than one thread of the kind: `trench router` asks for them).
fn watch() {
    drop(ZRuntime::Net.spawn(async {}));
    drop(ZRuntime::Acceptor.spawn(async {}));
}

/// Runs a router as rmw_zenoh's `rmw_zenohd` does (ZENOH_ROUTER_CONFIG_URI, ZENOH_CONFIG_OVERRIDE) until SIGINT or SIGTERM.
/// `ready` is told its name in the network and where it listens.
///
/// # Errors
/// When the configuration is wrong or the router cannot listen.
pub fn route(ready: impl FnOnce(&str, &[String])) -> Result<(), RouterError> {
    let config = configuration::router().map_err(RouterError::Configuration)?;
    let mut poll = Poll::new()?;
    let mut signals = Signals::new()?;
    signals.register(poll.registry(), Token(0))?;
    let router = zenoh::open(config).wait().map_err(|error| RouterError::Open(error.to_string()))?;
    let locators: Vec<String> = router.info().locators().wait().iter().map(ToString::to_string).collect();
    ready(&router.zid().to_string(), &locators);
    let mut events = Events::with_capacity(1);
    while events.is_empty() {
        match poll.poll(&mut events, Some(WATCH)) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            other => other?,
        }
        watch();
    }
    // What remains to be said at the end is said or never will be.
    let _closed = router.close().wait();
    Ok(())
}
