//! An analysis as a person reads it.

use super::{Analysis, Noise, Spread};
use std::fmt::{self, Display};

/// So many visits of zone 1 are told one by one.
const MOST_VISITS: usize = 20;

impl Display for Analysis {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.tell_conformance(out)?;
        self.tell_distances(out)?;
        self.tell_links(out)?;
        self.tell_traffic(out)?;
        self.tell_latencies(out)
    }
}

impl Analysis {
    fn tell_conformance(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.conformance.is_empty() {
            return Ok(());
        }
        let time = |time: Option<f64>| time.map_or("-".to_owned(), |time| format!("{time:.2}"));
        writeln!(out, "\n{:<12} {:>14} {:>14} {:>17}", "robot", "conforms (s)", "for good (s)", "from segment (m)")?;
        for robot in &self.conformance {
            let (first, for_good) = (time(robot.first), time(robot.for_good));
            writeln!(out, "{:<12} {first:>14} {for_good:>14} {:>17.4}", robot.robot, robot.final_distance)?;
        }
        let last = self.conformance.iter().map(|robot| robot.for_good).collect::<Option<Vec<_>>>();
        let last = last.map(|times| times.into_iter().fold(0.0, f64::max));
        writeln!(out, "time to conform, the whole team: {} s", time(last))
    }

    fn tell_distances(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(out)?;
        for clearance in &self.clearances {
            let (robot, obstacle, gap) = (&clearance.robot, clearance.obstacle, clearance.gap);
            writeln!(out, "{robot}: nearest obstacle {gap:.4} m  (number {obstacle}, t = {:.2} s)", clearance.time)?;
        }
        writeln!(out, "visits of zone 1        {:>9}", self.zone_visits.len())?;
        for visit in self.zone_visits.iter().take(MOST_VISITS) {
            let ([a, b], from, to) = (&visit.robots, visit.from, visit.to);
            writeln!(out, "  {a} and {b}, t = {from:.2} to {to:.2} s, {:.4} m between centres", visit.distance)?;
        }
        if self.zone_visits.len() > MOST_VISITS {
            writeln!(out, "  and {} more", self.zone_visits.len() - MOST_VISITS)?;
        }
        Ok(())
    }

    fn tell_links(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.links.is_empty() {
            return Ok(());
        }
        let heads = ["link", "up (%)", "down (s)", "loss (%)", "worst (%)", "round trip (ms)", "hops", "faults"];
        let [link, up, down, loss, worst, trip, hops, faults] = heads;
        writeln!(out, "\n{link:<12} {up:>7} {down:>9} {loss:>9} {worst:>10} {trip:>18} {hops:>5} {faults:>7}")?;
        for link in &self.links {
            let trip = link.round_trip.map_or("-".to_owned(), |trip| milliseconds(&trip));
            writeln!(
                out,
                "{:<12} {:>7.2} {:>9.2} {:>9.2} {:>10.2} {trip:>18} {:>5} {:>7}",
                link.robot,
                100.0 * link.up,
                link.longest_down,
                100.0 * link.loss,
                100.0 * link.worst_loss,
                link.hops,
                link.faults
            )?;
        }
        Ok(())
    }

    fn tell_traffic(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let heads = ("topic", "count", "rate (Hz)", "gap (s)", "at t (s)", "age p50/p99/max (ms)");
        writeln!(
            out,
            "\n{:<34} {:>7} {:>10} {:>9} {:>9} {:>22}",
            heads.0, heads.1, heads.2, heads.3, heads.4, heads.5
        )?;
        let number =
            |value: Option<f64>, digits: usize| value.map_or("-".to_owned(), |value| format!("{value:.digits$}"));
        for topic in self.traffic.iter().filter(|topic| topic.count > 0) {
            let (rate, gap) = (number(topic.rate, 1), number(topic.longest_gap.map(|gap| gap.length), 3));
            let from = number(topic.longest_gap.map(|gap| gap.from), 2);
            let age = topic.age.map_or("-".to_owned(), |age| milliseconds(&age));
            writeln!(out, "{:<34} {:>7} {rate:>10} {gap:>9} {from:>9} {age:>22}", topic.topic, topic.count)?;
        }
        Ok(())
    }

    fn tell_latencies(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(first) = self.latencies.first() {
            writeln!(out, "\n{:<34} {:>7} {:>22}", format!("from {} to", first.from), "count", "p50/p99/max (ms)")?;
        }
        for latency in &self.latencies {
            writeln!(out, "{:<34} {:>7} {:>22}", latency.to, latency.count, milliseconds(&latency.seconds))?;
        }
        Ok(())
    }
}

/// Times in s, told in ms.
fn milliseconds(spread: &Spread) -> String {
    format!("{:.2}/{:.2}/{:.2}", spread.p50 * 1e3, spread.p99 * 1e3, spread.max * 1e3)
}

impl Display for Noise {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { samples, missing, rate, x, y, theta } = self;
        writeln!(out, "{samples} poses at {rate:.1} Hz, {missing} missing between them")?;
        for (name, unit, series) in [("x", "m", x), ("y", "m", y), ("theta", "rad", theta)] {
            let (mean, deviation, kurtosis) = (series.mean, series.deviation, series.excess_kurtosis);
            writeln!(
                out,
                "{name:<6} mean {mean:>10.5} {unit:<3}  deviation {deviation:.3e} {unit:<3}  excess kurtosis {kurtosis:>6.2}"
            )?;
        }
        Ok(())
    }
}
