//! Comparing outputs step by step.

use super::difference::{Changes, Difference, Pair};
use super::report::{Elapsed, Report, Verdict};
use super::subject::Subjects;
use super::tolerance::Tolerances;
use trench_core::{StartError, Times};
use trench_journal::{Output, Port, Ports, Record, Records, Start};

/// Counts what is equal and keeps the first thing that is not.
pub(super) struct Comparison {
    node: String,
    subjects: Subjects,
    tolerances: Tolerances,
    elapsed: Elapsed,
    events: u64,
    outputs: u64,
    equal: u64,
    tolerated: u64,
    first: Option<Box<Difference>>,
    changes: Changes,
}

impl Comparison {
    pub(super) fn new(start: &Start, tolerances: &Tolerances) -> Self {
        Self {
            node: start.full_name(),
            subjects: Subjects::new(&start.ports),
            tolerances: tolerances.clone(),
            elapsed: Elapsed::default(),
            events: 0,
            outputs: 0,
            equal: 0,
            tolerated: 0,
            first: None,
            changes: Changes::default(),
        }
    }

    /// The step that is compared next.
    pub(super) fn at(&mut self, at: Times) {
        self.elapsed.at(at);
    }

    /// The node does not start: its first difference.
    pub(super) fn refusal(mut self, error: &StartError) -> Report {
        self.differs("start", "the node started", &error.to_string());
        self.finish()
    }

    /// Compares what the core was and is connected to: indices mean other things where that changed.
    pub(super) fn interface(&mut self, recorded: &Ports, now: &Ports) {
        let pairs = [
            ("subscriptions", &recorded.subscriptions, &now.subscriptions),
            ("publications", &recorded.publications, &now.publications),
            ("services", &recorded.services, &now.services),
            ("clients", &recorded.clients, &now.clients),
        ];
        let text = |port: Option<&Port>| match port {
            Some(port) => format!("{} ({})", port.name, port.type_name),
            None => "nothing".to_owned(),
        };
        for (what, recorded, now) in pairs {
            // Names are not compared: remapping is the process's, not the core's.
            let same = |(was, is): &(&Port, &Port)| was.type_hash == is.type_hash;
            let at = recorded.iter().zip(now).take_while(same).count();
            if at < recorded.len().max(now.len()) {
                self.differs(&format!("{what}[{at}]"), &text(recorded.get(at)), &text(now.get(at)));
            }
        }
    }

    fn differs(&mut self, subject: &str, recorded: &str, now: &str) {
        let pair = Pair { path: String::new(), recorded: recorded.to_owned(), now: now.to_owned(), by: None };
        self.note(subject.to_owned(), pair);
    }

    fn note(&mut self, subject: String, pair: Pair) {
        self.changes.add(&subject, &pair);
        if self.first.is_none() {
            let (node, seconds, ros) = (self.node.clone(), self.elapsed.seconds(), self.elapsed.times().ros);
            self.first = Some(Box::new(Difference {
                node,
                seconds,
                ros,
                subject,
                pair,
                equal_before: self.equal + self.tolerated,
            }));
        }
    }

    /// Compares the outputs of one step.
    pub(super) fn step(&mut self, recorded: Records<'_>, now: &[u8]) {
        self.events += 1;
        let same = recorded.rest() == now;
        let mut recorded = outputs(recorded);
        if same {
            let count = recorded.count() as u64;
            self.outputs += count;
            self.equal += if self.first.is_none() { count } else { 0 };
            return;
        }
        let mut now = outputs(Records::new(now));
        loop {
            let (was, is) = (recorded.next(), now.next());
            self.outputs += u64::from(was.is_some());
            match (was, is) {
                (None, None) => return,
                (was, is) if was == is => self.equal += u64::from(self.first.is_none()),
                (was, is) => match self.subjects.compare(was.as_ref(), is.as_ref(), &self.tolerances) {
                    Some((subject, pair)) => self.note(subject, pair),
                    None => self.tolerated += u64::from(self.first.is_none()),
                },
            }
        }
    }

    /// The journal ends before its end.
    pub(super) fn stopped(mut self, reason: String) -> Report {
        let first = self.first.take();
        let from = self.elapsed.seconds();
        let verdict = first.map_or(Verdict::NotReplayable { from, reason }, Verdict::Differs);
        self.report(verdict)
    }

    /// The journal is through.
    pub(super) fn finish(mut self) -> Report {
        let verdict = self.first.take().map_or(Verdict::Equal, Verdict::Differs);
        self.report(verdict)
    }

    fn report(self, verdict: Verdict) -> Report {
        Report {
            node: self.node,
            events: self.events,
            outputs: self.outputs,
            equal: self.equal,
            tolerated: self.tolerated,
            seconds: self.elapsed.seconds(),
            verdict,
            changes: self.changes,
        }
    }
}

fn outputs<'a>(records: Records<'a>) -> impl Iterator<Item = Output<'a>> {
    records.filter_map(|record| match record {
        Record::Output(output) => Some(output),
        Record::Input(_) | Record::End(_) => None,
    })
}
