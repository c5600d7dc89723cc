//! Following the connections to routers, over which a process reaches others.

use crate::transport::network::GraphChange;
use std::collections::{BTreeMap, BTreeSet};
use zenoh::config::WhatAmI;
use zenoh::sample::SampleKind;
use zenoh::session::{LinkEvent, TransportEvent};

/// What Zenoh tells of its connections.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum ConnectionChange {
    /// This process reaches somebody there.
    Link { name: String, at: String },
    /// A router is no longer reached: its process ended, or the connection did.
    RouterGone { name: String },
}

impl ConnectionChange {
    /// Of a link that is new; those that end say nothing that the end of the connection does not.
    pub(super) fn of_link(event: &LinkEvent) -> Option<Self> {
        let link = event.link();
        let new = event.kind() == SampleKind::Put;
        new.then(|| Self::Link { name: link.zid().to_string(), at: link.dst().to_string() })
    }

    /// Of a connection to a router that ends; of one that is new its link has said where.
    pub(super) fn of_transport(event: &TransportEvent) -> Option<Self> {
        let transport = event.transport();
        let ends = event.kind() == SampleKind::Delete && transport.whatami() == WhatAmI::Router;
        ends.then(|| Self::RouterGone { name: transport.zid().to_string() })
    }
}

/// Pure: what Zenoh tells in, what nodes want to know out.
#[derive(Debug, Default)]
pub(super) struct Routers {
    /// Where somebody is reached, by name.
    places: BTreeMap<String, String>,
    /// Where a router is missed.
    missed: BTreeSet<String>,
}

impl Routers {
    pub(super) fn follow(&mut self, change: ConnectionChange, changes: &mut Vec<GraphChange>) {
        match change {
            ConnectionChange::Link { name, at } => {
                // A router that was started again has another name in the same place.
                if self.missed.remove(&at) {
                    changes.push(GraphChange::Router { at: at.clone(), is_there: true });
                }
                self.places.insert(name, at);
            }
            ConnectionChange::RouterGone { name } => {
                let Some(at) = self.places.remove(&name) else { return };
                // One that was started again may have been told of before its last life's end.
                let is_there_again = self.places.values().any(|place| *place == at);
                if !is_there_again && self.missed.insert(at.clone()) {
                    changes.push(GraphChange::Router { at, is_there: false });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link(name: &str, at: &str) -> ConnectionChange {
        ConnectionChange::Link { name: name.to_owned(), at: at.to_owned() }
    }

    fn gone(name: &str) -> ConnectionChange {
        ConnectionChange::RouterGone { name: name.to_owned() }
    }

    #[test]
    fn a_router_is_missed_once_and_found_where_it_was_under_another_name() {
        let mut routers = Routers::default();
        let mut follow = |change| {
            let mut changes = Vec::new();
            routers.follow(change, &mut changes);
            changes
        };
        let told = |is_there| vec![GraphChange::Router { at: "tcp/10.0.0.1:7447".to_owned(), is_there }];
        assert_eq!(follow(link("a", "tcp/10.0.0.1:7447")), []);
        assert_eq!(follow(link("peer", "tcp/10.0.0.2:40000")), []);
        assert_eq!(follow(gone("a")), told(false));
        assert_eq!(follow(gone("a")), []);
        assert_eq!(follow(link("b", "tcp/10.0.0.1:7447")), told(true));
        assert_eq!(follow(link("c", "tcp/10.0.0.1:7447")), []);
        assert_eq!(follow(gone("b")), [], "its next life is there already");
        assert_eq!(follow(gone("c")), told(false));
    }
}
