//! Remapping rules: other names for topics, services, the node and its namespace.

use super::UsageError;
use crate::resolve_name;

/// What a rule renames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    Node,
    Namespace,
    Any,
    /// Of a topic.
    Topic,
    /// Of a service.
    Service,
}

/// One `-r [node:]from:=to`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remap {
    node: Option<String>,
    target: Target,
    from: String,
    to: String,
}

/// Names of topics and services are remapped alike, but a rule can be for one kind alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NameKind {
    /// Of a topic.
    Topic,
    /// Of a service.
    Service,
}

impl Remap {
    /// Reads `[node:]from:=to`, `__node:=name`, `__ns:=/namespace`, `rostopic://from:=to` or `rosservice://from:=to`.
    ///
    /// # Errors
    /// When `text` is none of these.
    pub fn parse(text: &str) -> Result<Self, UsageError> {
        let wrong = || UsageError::Remap(text.to_owned());
        let (mut from, to) = text.split_once(":=").ok_or_else(wrong)?;
        let mut node = None;
        // The colon of `rostopic://` is not that of `node:`.
        if let Some((prefix, name)) = from.split_once(':')
            && !name.starts_with("//")
        {
            node = Some(prefix.to_owned());
            from = name;
        }
        let (target, from) = match from {
            "__node" | "__name" => (Target::Node, ""),
            "__ns" => (Target::Namespace, ""),
            _ => match (from.strip_prefix("rostopic://"), from.strip_prefix("rosservice://")) {
                (Some(topic), _) => (Target::Topic, topic),
                (_, Some(service)) => (Target::Service, service),
                _ => (Target::Any, from),
            },
        };
        let named = !matches!(target, Target::Node | Target::Namespace);
        let relative_namespace = target == Target::Namespace && !to.starts_with('/');
        if to.is_empty() || (named && from.is_empty()) || node.as_deref() == Some("") || relative_namespace {
            return Err(wrong());
        }
        Ok(Self { node, target, from: from.to_owned(), to: to.to_owned() })
    }

    /// `__ns:=namespace`, for any node; the namespace is absolute.
    pub(super) fn namespace(namespace: String) -> Self {
        Self { node: None, target: Target::Namespace, from: String::new(), to: namespace }
    }

    fn is_for(&self, node: &str) -> bool {
        self.node.as_deref().is_none_or(|name| name == node)
    }
}

/// A node's name and namespace once remapped, and the rules for its topics and services.
#[derive(Debug, Clone)]
pub struct Names<'a> {
    /// The node's name.
    pub node: String,
    /// Its namespace, absolute.
    pub namespace: String,
    remaps: &'a [Remap],
}

impl<'a> Names<'a> {
    /// For the node whose executable calls it `default_name`.
    pub fn new(remaps: &'a [Remap], default_name: &str) -> Self {
        let find = |target| remaps.iter().find(|remap| remap.target == target && remap.is_for(default_name));
        let node = find(Target::Node).map_or(default_name, |remap| &remap.to).to_owned();
        let namespace = find(Target::Namespace).map_or("/", |remap| &remap.to);
        let namespace = if namespace == "/" { namespace } else { namespace.trim_end_matches('/') };
        Self { node, namespace: namespace.to_owned(), remaps }
    }

    /// The absolute name that the core's `name` has on the network.
    pub fn resolve(&self, name: &str, kind: NameKind) -> String {
        let absolute = resolve_name(name, &self.namespace, &self.node);
        let applies = |remap: &&Remap| {
            let kind_fits = match remap.target {
                Target::Any => true,
                Target::Topic => kind == NameKind::Topic,
                Target::Service => kind == NameKind::Service,
                Target::Node | Target::Namespace => false,
            };
            kind_fits && remap.is_for(&self.node) && resolve_name(&remap.from, &self.namespace, &self.node) == absolute
        };
        match self.remaps.iter().find(applies) {
            Some(remap) => resolve_name(&remap.to, &self.namespace, &self.node),
            None => absolute,
        }
    }
}
