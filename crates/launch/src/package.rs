//! Finding packages through the ament index and executables on PATH.

use crate::scope::Scope;
use crate::substitution::Failure;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// The share folder of an installed package.
pub(crate) fn share(package: &str, scope: &Scope) -> Result<String, Failure> {
    Ok(prefix(package, scope)?.join("share").join(package).display().to_string())
}

/// The file of `executable` of an installed package.
pub(crate) fn executable(package: &str, executable: &str, scope: &Scope) -> Result<String, Failure> {
    let folder = prefix(package, scope)?.join("lib").join(package);
    let file = folder.join(executable);
    if is_executable(&file) {
        return Ok(file.display().to_string());
    }
    let problem = format!("package `{package}` has no executable `{executable}`");
    Err(Failure::new(problem, format!("it would be in {}", folder.display())))
}

/// The file that running `command` (a path, or a name on the `PATH` given) runs, if there is one.
pub(crate) fn which(command: &str, path: &str) -> Option<PathBuf> {
    if command.contains('/') {
        return Some(PathBuf::from(command)).filter(|file| is_executable(file));
    }
    path.split(':')
        .filter(|folder| !folder.is_empty())
        .map(|folder| Path::new(folder).join(command))
        .find(|file| is_executable(file))
}

fn prefix(package: &str, scope: &Scope) -> Result<PathBuf, Failure> {
    let search = scope.environment.get("AMENT_PREFIX_PATH").map(String::as_str).unwrap_or_default();
    search
        .split(':')
        .filter(|prefix| !prefix.is_empty())
        .map(PathBuf::from)
        .find(|prefix| prefix.join("share/ament_index/resource_index/packages").join(package).exists())
        .ok_or_else(|| {
            let problem = format!("package `{package}` is not installed (AMENT_PREFIX_PATH is `{search}`)");
            Failure::new(problem, "source its setup file, or leave `pkg` out and put the executable on PATH")
        })
}

fn is_executable(file: &Path) -> bool {
    file.metadata().is_ok_and(|metadata| metadata.is_file() && metadata.permissions().mode() & 0o111 != 0)
}
