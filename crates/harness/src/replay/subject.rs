//! What an output is about, and in which field two of them differ.

use super::difference::Pair;
use super::text::describe;
use std::collections::BTreeMap;
use trench_journal::{Output, Payload, Port, Ports};
use trench_msgs::dynamic::{Schema, Value};

/// The names of a node's ports, and their types once a difference made them interesting.
pub(super) struct Subjects {
    ports: Ports,
    schemas: BTreeMap<String, Option<Schema>>,
}

impl Subjects {
    pub(super) fn new(ports: &Ports) -> Self {
        Self { ports: ports.clone(), schemas: BTreeMap::new() }
    }

    /// What two outputs, of which at least one exists, are about, and where they differ.
    pub(super) fn compare(&mut self, recorded: Option<&Output<'_>>, now: Option<&Output<'_>>) -> (String, Pair) {
        let subject = recorded.or(now).map(|output| self.subject(output)).unwrap_or_default();
        let of_one_subject = now.is_none_or(|now| self.subject(now) == subject);
        let pair = match (recorded.and_then(cdr), now.and_then(cdr)) {
            (Some(was), Some(is)) if of_one_subject => self.fields(&subject, was, is),
            _ => None,
        };
        let whole = || {
            let text = |output: Option<&Output<'_>>| {
                let named = output.filter(|_| !of_one_subject).map(|output| self.subject(output) + " ");
                named.unwrap_or_default() + &output.map_or("nothing".to_owned(), describe)
            };
            Pair { path: String::new(), recorded: text(recorded), now: text(now), by: None }
        };
        let pair = pair.unwrap_or_else(whole);
        (subject, pair)
    }

    fn subject(&self, output: &Output<'_>) -> String {
        let named = |ports: &[Port], index: usize, what: &str| {
            ports.get(index).map_or_else(|| format!("{what} {index}"), |port| port.name.clone())
        };
        match *output {
            Output::Publish { port, .. } => named(&self.ports.publications, port, "publication"),
            Output::Respond { service, .. } => named(&self.ports.services, service, "service") + " (response)",
            Output::Call { client, .. } => named(&self.ports.clients, client, "client") + " (request)",
            Output::Write { stream, .. } => {
                let stream_name = || format!("stream {stream}");
                self.ports.byte_streams.get(stream).cloned().unwrap_or_else(stream_name)
            }
            Output::Log { .. } => "log".to_owned(),
            Output::Checkpoint(_) => "checkpoint".to_owned(),
            Output::Exit(_) => "exit".to_owned(),
            Output::NextWakeup(_) => "next wakeup".to_owned(),
            Output::Accepted | Output::Refused(_) => "change of parameters".to_owned(),
        }
    }

    /// The first field in which two messages of a topic or service differ.
    fn fields(&mut self, subject: &str, recorded: &[u8], now: &[u8]) -> Option<Pair> {
        let type_name = self.type_of(subject)?;
        let parse = || {
            let info = trench_msgs::type_named(&type_name)?;
            Schema::parse(info.name, info.definition).ok()
        };
        let schema = self.schemas.entry(type_name.clone()).or_insert_with(parse).as_ref()?;
        let (recorded, now) = (schema.decode(recorded).ok()?, schema.decode(now).ok()?);
        let (recorded, now) = (recorded.leaves(), now.leaves());
        let same = |(was, is): &(&(String, &Value), &(String, &Value))| was.0 == is.0 && bits(was.1) == bits(is.1);
        let at = recorded.iter().zip(&now).take_while(same).count();
        let (was, is) = (recorded.get(at), now.get(at));
        let path = was.or(is)?.0.clone();
        let text = |leaf: Option<&(String, &Value)>| match leaf {
            Some((other, value)) if *other != path => format!("{other} = {value}"),
            Some((_, value)) => value.to_string(),
            None => "nothing".to_owned(),
        };
        let number = |leaf: Option<&(String, &Value)>| leaf.filter(|leaf| leaf.0 == path)?.1.as_f64();
        let by = number(was).zip(number(is)).map(|(was, is)| (was - is).abs());
        Some(Pair { recorded: text(was), now: text(is), path, by })
    }

    fn type_of(&self, subject: &str) -> Option<String> {
        let of =
            |ports: &[Port], name: &str| ports.iter().find(|port| port.name == name).map(|port| port.type_name.clone());
        if let Some(service) = subject.strip_suffix(" (response)") {
            return of(&self.ports.services, service).map(|name| name + "_Response");
        }
        if let Some(service) = subject.strip_suffix(" (request)") {
            return of(&self.ports.clients, service).map(|name| name + "_Request");
        }
        of(&self.ports.publications, subject)
    }
}

/// The message of an output, where it stands in the journal.
fn cdr<'a>(output: &Output<'a>) -> Option<&'a [u8]> {
    match *output {
        Output::Publish { payload: Payload::Value(cdr), .. }
        | Output::Respond { cdr, .. }
        | Output::Call { cdr, .. } => Some(cdr),
        _ => None,
    }
}

/// A leaf for comparison: numbers by their bits, so that -0 is not 0 and every NaN is itself.
fn bits(value: &Value) -> Value {
    match value {
        Value::Float32(number) => Value::Unsigned(number.to_bits().into()),
        Value::Float64(number) => Value::Unsigned(number.to_bits()),
        other => other.clone(),
    }
}
