//! Following liveliness tokens: who is at the other ends of this process's topics and services; and whether routers are there.

use super::entity::{Entity, Kind, gid};
use super::inbox::{Inbox, wakes_by};
use super::routers::{ConnectionChange, Routers};
use crate::transport::network::{Gid, GraphChange, GraphWatch};
use std::collections::{BTreeMap, BTreeSet};

/// A token came or went.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TokenChange {
    pub(super) key: String,
    pub(super) alive: bool,
}

/// What Zenoh tells of others.
#[derive(Debug)]
pub(super) enum News {
    /// Of their ends.
    Token(TokenChange),
    /// Of the ways to them.
    Connection(ConnectionChange),
}

/// All ends that are alive, those of this process among them, and the routers.
pub(super) struct Graph {
    inbox: Inbox<News>,
    ends: Ends,
    routers: Routers,
}

wakes_by!(Graph, inbox);

impl Graph {
    /// For the session that is named so in tokens.
    pub(super) fn new(session: String, inbox: Inbox<News>) -> Self {
        Self { inbox, ends: Ends { session, alive: BTreeMap::new() }, routers: Routers::default() }
    }
}

impl GraphWatch for Graph {
    fn take(&mut self) -> Vec<GraphChange> {
        self.inbox.clear_wakeup();
        let mut changes = Vec::new();
        while let Some(news) = self.inbox.take() {
            match news {
                News::Token(change) => self.ends.follow(&change, &mut changes),
                News::Connection(change) => self.routers.follow(change, &mut changes),
            }
        }
        changes
    }
}

/// Pure: tokens in, changes out.
struct Ends {
    session: String,
    /// By their tokens; whether an end is this process's own stands beside it.
    alive: BTreeMap<String, (Entity, bool)>,
}

impl Ends {
    fn follow(&mut self, change: &TokenChange, changes: &mut Vec<GraphChange>) {
        let Some((session, entity)) = Entity::parse(&change.key) else { return };
        let own = session == self.session;
        let is_news = if change.alive {
            self.alive.insert(change.key.clone(), (entity.clone(), own)).is_none()
        } else {
            self.alive.remove(&change.key).is_some()
        };
        if !is_news {
            return;
        }
        if change.alive && own {
            if entity.kind == Kind::Subscription {
                let writers = self.alive.iter().filter(|(_, (other, _))| other.matches(&entity));
                changes.extend(writers.map(|(writer, _)| presence(&change.key, writer, true)));
            }
            self.tell(&change.key, &entity, changes);
        }
        if change.alive && !own && entity.kind == Kind::Publisher {
            changes.push(GraphChange::Writer {
                topic: entity.name.clone(),
                type_name: entity.ros_type(),
                type_hash: entity.type_hash.clone(),
                qos: entity.qos,
            });
        }
        for (key, (other, _)) in self.alive.iter().filter(|(_, (other, own))| *own && other.matches(&entity)) {
            if other.kind == Kind::Subscription {
                changes.push(presence(key, &change.key, change.alive));
            }
            self.tell(key, other, changes);
        }
    }

    /// Tells one of our ends who is at the other, by number.
    fn tell(&self, key: &str, entity: &Entity, changes: &mut Vec<GraphChange>) {
        let others = self.alive.iter().filter(|(_, (other, _))| other.matches(entity));
        let others: BTreeSet<Gid> = others.map(|(key, _)| gid(key)).collect();
        match entity.kind {
            Kind::Publisher => changes.push(GraphChange::Readers { writer: gid(key), readers: others }),
            Kind::Subscription | Kind::Client => {
                changes.push(GraphChange::Matched { reader: gid(key), writers: others.len() });
            }
            // Zenoh brings responses to whoever asked.
            Kind::Server => {}
        }
    }
}

fn presence(reader: &str, writer: &str, is_there: bool) -> GraphChange {
    GraphChange::Presence { reader: gid(reader), writer: gid(writer), is_there }
}

#[cfg(test)]
mod tests {
    use super::super::entity::NodeToken;
    use super::*;
    use trench_core::Qos;

    fn token(session: &str, number: u64, kind: Kind) -> String {
        let node = NodeToken {
            domain: 0,
            session: session.to_owned(),
            number: 0,
            namespace: String::new(),
            name: "n".to_owned(),
        };
        node.entity_key(number, &Entity::new(kind, "/chatter", "std_msgs/msg/String", "RIHS01_1", Qos::RELIABLE))
    }

    fn follow(ends: &mut Ends, key: &str, alive: bool) -> Vec<GraphChange> {
        let mut changes = Vec::new();
        ends.follow(&TokenChange { key: key.to_owned(), alive }, &mut changes);
        changes
    }

    #[test]
    fn each_end_hears_of_those_at_the_other() {
        let mut ends = Ends { session: "own".to_owned(), alive: BTreeMap::new() };
        let (reader, writer) = (token("own", 1, Kind::Subscription), token("far", 1, Kind::Publisher));
        let matched = |writers| GraphChange::Matched { reader: gid(&reader), writers };
        assert_eq!(follow(&mut ends, &reader, true), [matched(0)]);
        let presence = |is_there| presence(&reader, &writer, is_there);
        let found = follow(&mut ends, &writer, true);
        assert!(matches!(&found[0], GraphChange::Writer { topic, type_name, .. }
            if topic == "/chatter" && type_name == "std_msgs/msg/String"));
        assert_eq!(found[1..], [presence(true), matched(1)]);
        assert_eq!(follow(&mut ends, &writer, true), [], "told twice");
        assert_eq!(follow(&mut ends, &writer, false), [presence(false), matched(0)]);
        assert_eq!(follow(&mut ends, &writer, false), []);
    }

    #[test]
    fn ends_of_one_process_match_too() {
        let mut ends = Ends { session: "own".to_owned(), alive: BTreeMap::new() };
        let (reader, writer) = (token("own", 1, Kind::Subscription), token("own", 2, Kind::Publisher));
        follow(&mut ends, &reader, true);
        let readers = BTreeSet::from([gid(&reader)]);
        let expected = [
            GraphChange::Readers { writer: gid(&writer), readers },
            presence(&reader, &writer, true),
            GraphChange::Matched { reader: gid(&reader), writers: 1 },
        ];
        assert_eq!(follow(&mut ends, &writer, true), expected);
    }

    #[test]
    fn what_others_say_to_each_other_is_not_told() {
        let mut ends = Ends { session: "own".to_owned(), alive: BTreeMap::new() };
        assert_eq!(follow(&mut ends, &token("far", 1, Kind::Subscription), true), []);
        assert_eq!(follow(&mut ends, &token("far", 3, Kind::Client), true), []);
        assert_eq!(follow(&mut ends, "no token", true), []);
    }
}
