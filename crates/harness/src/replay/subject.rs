//! What an output is about, and in which field two of them differ.

use super::difference::Pair;
use super::text::describe;
use super::tolerance::Tolerances;
use std::collections::BTreeMap;
use trench_journal::{Output, Payload, Port, Ports};
use trench_msgs::dynamic::{Schema, Value};

/// The names of a node's ports, and their types once a difference made them interesting.
pub(super) struct Subjects {
    ports: Ports,
    schemas: BTreeMap<String, Option<Schema>>,
}

/// What comes of comparing two messages field by field.
enum Fields {
    /// This differs first.
    Differ(Pair),
    /// All that differs may.
    Near,
    /// They have no fields that are known.
    Unknown,
}

impl Subjects {
    pub(super) fn new(ports: &Ports) -> Self {
        Self { ports: ports.clone(), schemas: BTreeMap::new() }
    }

    /// What two outputs, of which at least one exists, are about, and where they differ; nothing where the tolerances
    /// allow all differences.
    pub(super) fn compare(
        &mut self,
        recorded: Option<&Output<'_>>,
        now: Option<&Output<'_>>,
        tolerances: &Tolerances,
    ) -> Option<(String, Pair)> {
        let subject = recorded.or(now).map(|output| self.subject(output)).unwrap_or_default();
        let of_one_subject = now.is_none_or(|now| self.subject(now) == subject);
        let fields = match (recorded.and_then(cdr), now.and_then(cdr)) {
            (Some(was), Some(is)) if of_one_subject => self.fields(&subject, was, is, tolerances),
            _ => Fields::Unknown,
        };
        let text = |output: Option<&Output<'_>>| {
            let named = output.filter(|_| !of_one_subject).map(|output| self.subject(output) + " ");
            named.unwrap_or_default() + &output.map_or("nothing".to_owned(), describe)
        };
        match fields {
            Fields::Near => None,
            Fields::Differ(pair) => Some((subject, pair)),
            Fields::Unknown => {
                let pair = Pair { path: String::new(), recorded: text(recorded), now: text(now), by: None };
                Some((subject, pair))
            }
        }
    }

    /// The number at `path` of an output, if it is one of `subject`.
    pub(super) fn value(&mut self, output: &Output<'_>, subject: &str, path: &str) -> Option<f64> {
        if self.subject(output) != subject {
            return None;
        }
        self.schema(subject)?.decode(cdr(output)?).ok()?.get(path)?.as_f64()
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

    fn schema(&mut self, subject: &str) -> Option<&Schema> {
        let type_name = self.type_of(subject)?;
        let parse = || {
            let info = trench_msgs::type_named(&type_name)?;
            Schema::parse(info.name, info.definition).ok()
        };
        self.schemas.entry(type_name.clone()).or_insert_with(parse).as_ref()
    }

    /// The first field in which two messages of a topic or service differ by more than they may.
    fn fields(&mut self, subject: &str, recorded: &[u8], now: &[u8], tolerances: &Tolerances) -> Fields {
        let decoded =
            self.schema(subject).and_then(|schema| Some((schema.decode(recorded).ok()?, schema.decode(now).ok()?)));
        let Some((recorded, now)) = decoded else { return Fields::Unknown };
        let (recorded, now) = (recorded.leaves(), now.leaves());
        let is_same = |(was, is): &(&(String, &Value), &(String, &Value))| was.0 == is.0 && bits(was.1) == bits(is.1);
        let is_near = |(was, is): &(&(String, &Value), &(String, &Value))| {
            let numbers = was.1.as_f64().zip(is.1.as_f64()).filter(|_| was.0 == is.0);
            numbers.is_some_and(|(before, after)| tolerances.allow(subject, &was.0, before, after))
        };
        let pairs = || recorded.iter().zip(&now);
        let at = pairs().take_while(|pair| is_same(pair) || is_near(pair)).count();
        let (was, is) = (recorded.get(at), now.get(at));
        let Some(path) = was.or(is).map(|leaf| leaf.0.clone()) else {
            // Bytes that differ in no field (bytes behind the message) are no matter of tolerance.
            return if pairs().all(|pair| is_same(&pair)) { Fields::Unknown } else { Fields::Near };
        };
        let text = |leaf: Option<&(String, &Value)>| match leaf {
            Some((other, value)) if *other != path => format!("{other} = {value}"),
            Some((_, value)) => value.to_string(),
            None => "nothing".to_owned(),
        };
        let number = |leaf: Option<&(String, &Value)>| leaf.filter(|leaf| leaf.0 == path)?.1.as_f64();
        let by = number(was).zip(number(is)).map(|(was, is)| (was - is).abs());
        Fields::Differ(Pair { recorded: text(was), now: text(is), path, by })
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
