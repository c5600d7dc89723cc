//! Whether this process keeps journals, and where.

use std::ffi::OsString;
use trench_journal::{Journals, Pace};

/// `TRENCH_JOURNAL_DIR` names the folder; with `TRENCH_JOURNAL_IMAGES=1` images that nodes read are kept by value.
pub(crate) fn journals(variable: impl Fn(&str) -> Option<OsString>) -> Option<Journals> {
    let folder = variable("TRENCH_JOURNAL_DIR").filter(|folder| !folder.is_empty())?;
    let images = variable("TRENCH_JOURNAL_IMAGES").is_some_and(|value| value == "1");
    Some(Journals { folder: folder.into(), images, pace: Pace::RealTime })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn journals_by_environment() {
        let check = |set: &[(&str, &str)], expected: Option<(&str, bool)>| {
            let variable = |name: &str| set.iter().find(|(key, _)| *key == name).map(|(_, value)| value.into());
            let found = journals(variable).map(|found| (found.folder, found.images));
            assert_eq!(found, expected.map(|(folder, images)| (folder.into(), images)), "{set:?}");
        };
        check(&[], None);
        check(&[("TRENCH_JOURNAL_DIR", "")], None);
        check(&[("TRENCH_JOURNAL_IMAGES", "1")], None);
        check(&[("TRENCH_JOURNAL_DIR", "/j")], Some(("/j", false)));
        check(&[("TRENCH_JOURNAL_DIR", "/j"), ("TRENCH_JOURNAL_IMAGES", "0")], Some(("/j", false)));
        check(&[("TRENCH_JOURNAL_DIR", "/j"), ("TRENCH_JOURNAL_IMAGES", "1")], Some(("/j", true)));
    }
}
