//! Files on their way into a journal and out of it.

use crate::disk::Disk;
use crate::start::FileText;
use sha2::{Digest, Sha256};
use std::cell::RefCell;
use trench_config::{ConfigError, Origin};
use trench_core::Files;

/// Reads through other [`Files`] and keeps what it read; of a secret, a fingerprint.
pub struct KeptFiles<'a> {
    inner: &'a dyn Files,
    kept: RefCell<Vec<FileText>>,
}

impl<'a> KeptFiles<'a> {
    /// Through `inner`.
    #[must_use]
    pub fn new(inner: &'a dyn Files) -> Self {
        Self { inner, kept: RefCell::default() }
    }

    /// What was read, in order.
    #[must_use]
    pub fn into_texts(self) -> Vec<FileText> {
        self.kept.into_inner()
    }

    fn keep(&self, path: &str, text: String) {
        self.kept.borrow_mut().push(FileText { path: path.to_owned(), text });
    }
}

impl Files for KeptFiles<'_> {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let text = self.inner.read(key, path)?;
        self.keep(path, text.clone());
        Ok(text)
    }

    fn read_secret(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let text = self.inner.read_secret(key, path)?;
        self.keep(path, fingerprint(&text));
        Ok(text)
    }
}

/// What a journal has in the place of a secret. It tells no more of a key than the tags of packets do, which the journal has too:
/// whoever guesses a key can try it on either.
fn fingerprint(secret: &str) -> String {
    let digest = Sha256::digest(secret.trim());
    let digits: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    format!("{SECRET}{digits}")
}

const SECRET: &str = "secret, not kept; SHA-256 ";

/// The files in a journal. Secrets, which are not in it, are read from the disk again.
pub struct RecordedFiles<'a>(pub &'a [FileText]);

impl RecordedFiles<'_> {
    fn find(&self, key: &str, path: &str) -> Result<&str, ConfigError> {
        let found = self.0.iter().find(|file| file.path == path).map(|file| file.text.as_str());
        found.ok_or_else(|| error(key, path, "was not read when the journal was recorded", ""))
    }
}

impl Files for RecordedFiles<'_> {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        self.find(key, path).map(str::to_owned)
    }

    fn read_secret(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let kept = self.find(key, path)?;
        if !kept.starts_with(SECRET) {
            // Of a program that kept secrets.
            return Ok(kept.to_owned());
        }
        let text = Disk.read_secret(key, path)?;
        if fingerprint(&text) != kept {
            let problem = "holds another secret than when the journal was recorded, and the journal does not keep it";
            return Err(error(key, path, problem, "put the file of that run back"));
        }
        Ok(text)
    }
}

fn error(key: &str, path: &str, problem: &str, remedy: &str) -> ConfigError {
    ConfigError {
        origin: Origin::new("journal", 0),
        key: key.to_owned(),
        value: path.to_owned(),
        problem: problem.to_owned(),
        remedy: remedy.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    #[test]
    fn a_secret_is_asked_for_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("key");
        let write = |text: &str| {
            std::fs::write(&path, text).unwrap();
            std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o600)).unwrap();
        };
        write("000102\n");
        let name = path.to_str().unwrap();
        let kept = KeptFiles::new(&Disk);
        assert_eq!(kept.read_secret("key_file", name).unwrap(), "000102\n");
        let texts = kept.into_texts();
        assert!(texts.len() == 1 && !texts[0].text.contains("000102"), "{texts:?}");
        assert_eq!(RecordedFiles(&texts).read_secret("key_file", name).unwrap(), "000102\n");
        write("000103\n");
        let told = RecordedFiles(&texts).read_secret("key_file", name).unwrap_err().to_string();
        assert!(told.contains("holds another secret"), "{told}");
        std::fs::remove_file(&path).unwrap();
        let told = RecordedFiles(&texts).read_secret("key_file", name).unwrap_err().to_string();
        assert!(told.contains("cannot be read"), "{told}");
    }
}
