//! DDS Security as every ROS 2 process is asked for it: by ROS_SECURITY_ENABLE, a keystore, and the name of an enclave in it.

use crate::transport::Backend;
use std::fs::File;
use std::path::PathBuf;
use trench_core::arguments::UsageError;

/// What an enclave has, as `ros2 security create_enclave` makes it.
const FILES: [&str; 6] =
    ["identity_ca.cert.pem", "cert.pem", "key.pem", "permissions_ca.cert.pem", "governance.p7s", "permissions.p7s"];

/// The folder of the enclave that this process is to be; none where nobody asks for security. `asked`: the enclave of the command line,
/// which ROS_SECURITY_ENCLAVE_OVERRIDE overrides.
///
/// There is no ROS_SECURITY_STRATEGY but `Enforce` here: whoever asks for secrecy must not be heard by everyone because a file is missing.
///
/// # Errors
/// Security over Zenoh, which has its own, or in a build without; a keystore that is not named; a file that is missing.
pub(crate) fn enclave(
    backend: Backend,
    variable: impl Fn(&str) -> Option<String>,
    asked: &str,
) -> Result<Option<PathBuf>, UsageError> {
    let given = |name| variable(name).filter(|text| !text.is_empty());
    if given("ROS_SECURITY_ENABLE").as_deref() != Some("true") {
        return Ok(None);
    }
    if backend == Backend::Zenoh {
        return Err(UsageError::SecurityOfZenoh);
    }
    if !cfg!(feature = "dds-security") {
        return Err(UsageError::SecurityNotBuilt);
    }
    let keystore = given("ROS_SECURITY_KEYSTORE").ok_or(UsageError::NoKeystore)?;
    let name = given("ROS_SECURITY_ENCLAVE_OVERRIDE").unwrap_or_else(|| asked.to_owned());
    let folder = PathBuf::from(keystore).join("enclaves").join(name.trim_start_matches('/'));
    for name in FILES {
        let path = folder.join(name);
        if let Err(error) = File::open(&path) {
            return Err(UsageError::Enclave { file: path.display().to_string(), problem: error.to_string() });
        }
    }
    Ok(Some(folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with<'a>(variables: &'a [(&str, &str)]) -> impl Fn(&str) -> Option<String> + 'a {
        |name| variables.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned())
    }

    #[test]
    fn without_being_asked_there_is_none() {
        for variables in [&[][..], &[("ROS_SECURITY_ENABLE", "false")], &[("ROS_SECURITY_KEYSTORE", "/keys")]] {
            assert_eq!(enclave(Backend::Dds, with(variables), "/"), Ok(None));
        }
    }

    #[test]
    fn zenoh_has_its_own() {
        let asked = enclave(Backend::Zenoh, with(&[("ROS_SECURITY_ENABLE", "true")]), "/");
        assert_eq!(asked, Err(UsageError::SecurityOfZenoh));
    }

    #[test]
    #[cfg(not(feature = "dds-security"))]
    fn a_build_without_says_so() {
        let asked = enclave(Backend::Dds, with(&[("ROS_SECURITY_ENABLE", "true")]), "/");
        assert_eq!(asked, Err(UsageError::SecurityNotBuilt));
    }

    #[test]
    #[cfg(feature = "dds-security")]
    fn the_enclave_is_found_or_what_is_missing_is_named() {
        let keystore = tempfile::tempdir().unwrap();
        let root = keystore.path().display().to_string();
        let variables = [("ROS_SECURITY_ENABLE", "true"), ("ROS_SECURITY_KEYSTORE", &*root)];
        assert_eq!(enclave(Backend::Dds, with(&variables[..1]), "/robot1"), Err(UsageError::NoKeystore));
        let folder = keystore.path().join("enclaves/robot1");
        std::fs::create_dir_all(&folder).unwrap();
        for name in FILES {
            match enclave(Backend::Dds, with(&variables), "/robot1") {
                Err(UsageError::Enclave { file, .. }) => assert_eq!(file, folder.join(name).display().to_string()),
                other => panic!("{other:?} without {name}"),
            }
            std::fs::write(folder.join(name), "").unwrap();
        }
        assert_eq!(enclave(Backend::Dds, with(&variables), "/robot1"), Ok(Some(folder.clone())));
        let over = [variables[0], variables[1], ("ROS_SECURITY_ENCLAVE_OVERRIDE", "/robot1")];
        assert_eq!(enclave(Backend::Dds, with(&over), "/other"), Ok(Some(folder)));
    }
}
