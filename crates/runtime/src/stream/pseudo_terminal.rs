//! A pseudo-terminal of which this process is the master: what opens the link sees a serial device.

use rustix::fs::{Mode, OFlags};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use std::ffi::OsString;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The master side, its link, and a slave kept open so that the line lives on while nobody else has it open.
pub(super) struct PseudoTerminal {
    link: String,
    slave: Option<(OwnedFd, PathBuf)>,
}

impl PseudoTerminal {
    pub(super) fn new(link: &str) -> Self {
        Self { link: link.to_owned(), slave: None }
    }

    pub(super) fn link(&self) -> &str {
        &self.link
    }

    pub(super) fn open(&mut self) -> io::Result<OwnedFd> {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&master)?;
        unlockpt(&master)?;
        let device = PathBuf::from(OsString::from_vec(ptsname(&master, Vec::new())?.into_bytes()));
        let slave = rustix::fs::open(&device, OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC, Mode::empty())?;
        let mut settings = tcgetattr(&slave)?;
        settings.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &settings)?;
        rustix::io::ioctl_fionbio(&master, true)?;
        replace_link(Path::new(&self.link), &device)?;
        self.slave = Some((slave, device));
        Ok(master)
    }
}

impl Drop for PseudoTerminal {
    fn drop(&mut self) {
        // Another process may have put its own link there meanwhile.
        if let Some((_, device)) = &self.slave
            && fs::read_link(&self.link).is_ok_and(|target| target == *device)
        {
            let _already_gone = fs::remove_file(&self.link);
        }
    }
}

/// Puts a link in place of an older one, never in place of a file.
fn replace_link(link: &Path, device: &Path) -> io::Result<()> {
    if fs::symlink_metadata(link).is_ok_and(|found| !found.is_symlink()) {
        return Err(io::Error::other("a file of this name exists and is no link; remove it or name another link"));
    }
    if let Some(folder) = link.parent() {
        fs::create_dir_all(folder)?;
    }
    let new = link.with_extension(format!("new{}", std::process::id()));
    symlink(device, &new)?;
    fs::rename(new, link)
}
