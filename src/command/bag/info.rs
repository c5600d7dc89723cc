//! What `trench bag info` prints, in the manner of `ros2 bag info`.

use std::fmt::{self, Display};
use trench_bag::BagReader;

/// A bag to be described.
pub(super) struct Info<'a>(pub(super) &'a BagReader);

impl Display for Info<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bag = self.0;
        let (first, last) = bag.span().unwrap_or((0, 0));
        let duration = last.saturating_sub(first) as f64 * 1e-9;
        for (index, (path, size)) in bag.files().enumerate() {
            writeln!(out, "{:<19}{} ({})", if index == 0 { "Files:" } else { "" }, path.display(), bytes(size))?;
        }
        writeln!(out, "{:<19}mcap", "Storage id:")?;
        writeln!(out, "{:<19}{duration:.9}s", "Duration:")?;
        writeln!(out, "{:<19}{}", "Start:", moment(first))?;
        writeln!(out, "{:<19}{}", "End:", moment(last))?;
        writeln!(out, "{:<19}{}", "Messages:", bag.message_count())?;
        let mut topics: Vec<_> = bag.topics().iter().collect();
        topics.sort_by(|a, b| a.name.cmp(&b.name));
        for (index, topic) in topics.iter().enumerate() {
            let heading = if index == 0 { "Topic information:" } else { "" };
            let rate = if duration > 0.0 { topic.message_count as f64 / duration } else { 0.0 };
            writeln!(
                out,
                "{heading:<19}Topic: {} | Type: {} | Count: {} | Rate: {rate:.1} Hz | Serialization Format: cdr",
                topic.name, topic.type_name, topic.message_count
            )?;
        }
        for (index, damage) in bag.damage().iter().enumerate() {
            writeln!(out, "{:<19}{damage}", if index == 0 { "Damage:" } else { "" })?;
        }
        Ok(())
    }
}

/// A time in ns, as a date where it is one and in seconds.
fn moment(nanoseconds: u64) -> String {
    let seconds = nanoseconds as f64 * 1e-9;
    let date = jiff::Timestamp::from_nanosecond(i128::from(nanoseconds)).map(|date| format!("{date:.3} "));
    format!("{}({seconds:.9})", date.unwrap_or_default())
}

fn bytes(size: u64) -> String {
    const STEPS: [(u64, &str); 3] = [(1 << 30, "GiB"), (1 << 20, "MiB"), (1 << 10, "KiB")];
    STEPS
        .iter()
        .find(|&&(unit, _)| size >= unit)
        .map_or_else(|| format!("{size} B"), |&(unit, name)| format!("{:.1} {name}", size as f64 / unit as f64))
}
