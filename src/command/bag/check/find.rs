//! Where the journals are.

use std::path::{Path, PathBuf};
use trench_journal::JournalReader;

/// Why there is nothing to check.
#[derive(Debug, thiserror::Error)]
pub(super) enum FindError {
    #[error("{path}: {error}", path = path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error("no journals in {} or in a folder `journals` in it or beside it; record with trench launch --journal", .0.display())]
    None(PathBuf),
    #[error("no journal of a node {name}; there are those of {}", known.join(", "))]
    NoSuchNode { name: String, known: Vec<String> },
}

/// The journals that `path` means, ordered by name.
pub(super) fn journals(path: &Path) -> Result<Vec<PathBuf>, FindError> {
    if path.is_file() {
        return Ok(vec![path.to_owned()]);
    }
    let inside = path.join("journals");
    let beside = path.parent().unwrap_or(Path::new("")).join("journals");
    let is_bag = is_bag(path);
    let folder = match () {
        () if inside.is_dir() => inside,
        () if is_bag && beside.is_dir() => beside,
        () if is_bag => return Err(FindError::None(path.to_owned())),
        () => path.to_owned(),
    };
    let found = mcap_files(&folder).map_err(|error| FindError::Read { path: folder, error })?;
    if found.is_empty() {
        return Err(FindError::None(path.to_owned()));
    }
    Ok(found)
}

/// Whether this is a bag's folder, also one that its recorder could not finish.
fn is_bag(path: &Path) -> bool {
    let first = path.file_name().map(|name| format!("{}_0.mcap", name.to_string_lossy()));
    path.join("metadata.yaml").exists() || first.is_some_and(|first| path.join(first).exists())
}

fn mcap_files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "mcap") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// Those of the node `name`: a full name or its last part.
pub(super) fn of_node(paths: Vec<PathBuf>, name: &str) -> Result<Vec<PathBuf>, FindError> {
    let mut known = Vec::new();
    let mut found = Vec::new();
    for path in paths {
        // A journal that cannot be opened names no node.
        let Ok(journal) = JournalReader::open(&path) else { continue };
        let full = journal.start().full_name();
        if full == name || journal.start().name == name {
            found.push(path);
        }
        known.push(full);
    }
    if found.is_empty() { Err(FindError::NoSuchNode { name: name.to_owned(), known }) } else { Ok(found) }
}
