//! Outputs in words.

use trench_journal::{Output, Payload};

/// An output as a reader of reports wants it: short.
pub(super) fn describe(output: &Output<'_>) -> String {
    match *output {
        Output::Publish { payload: Payload::Value(cdr), .. } => format!("a message of {} bytes", cdr.len()),
        Output::Publish { payload: Payload::Reference { length, hash }, .. } => {
            format!("a message of {length} bytes with hash {hash:032x}")
        }
        Output::Respond { cdr, id, .. } => format!("a response of {} bytes to request {id}", cdr.len()),
        Output::Call { cdr, .. } => format!("a request of {} bytes", cdr.len()),
        Output::Write { bytes, .. } => format!("{} bytes {}", bytes.len(), hexadecimal(bytes)),
        Output::Log { level, text } => format!("level {level} {text:?}"),
        Output::Checkpoint(bytes) => format!("{} bytes {}", bytes.len(), hexadecimal(bytes)),
        Output::Exit(code) => format!("code {code}"),
        Output::NextWakeup(None) => "never".to_owned(),
        Output::NextWakeup(Some(at)) => format!("{:.9} s", at as f64 * 1e-9),
        Output::Accepted => "accepted".to_owned(),
        Output::Refused(reason) => format!("refused: {reason}"),
    }
}

/// The first bytes.
fn hexadecimal(bytes: &[u8]) -> String {
    const SHOWN: usize = 24;
    let shown: Vec<String> = bytes.iter().take(SHOWN).map(|byte| format!("{byte:02x}")).collect();
    shown.join(" ") + if bytes.len() > SHOWN { " ..." } else { "" }
}
