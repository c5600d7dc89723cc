//! Where lines go: the screen, `launch.log`, and a log file for each process.

use super::SuperviseError;
use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex};

/// Longer lines are cut into pieces of this length, so that a process cannot fill the memory.
const LONGEST_LINE: u64 = 64 * 1024;

/// How many lines of a process's standard error are kept, for it to be quoted at the end of the run.
const MOST_LAST_WORDS: usize = 20;

/// The last lines that a process wrote on its standard error.
#[derive(Debug, Clone, Default)]
pub(super) struct LastWords(Arc<Mutex<VecDeque<String>>>);

impl LastWords {
    fn add(&self, line: &str) {
        if let Ok(mut lines) = self.0.lock() {
            if lines.len() == MOST_LAST_WORDS {
                lines.pop_front();
            }
            lines.push_back(line.to_owned());
        }
    }

    /// All of them, a line each.
    pub(super) fn text(&self) -> String {
        self.0.lock().map(|lines| lines.iter().cloned().collect::<Vec<_>>().join("\n")).unwrap_or_default()
    }
}

/// Writes lines. All copies share their files.
#[derive(Debug, Clone)]
pub(super) struct Console {
    folder: PathBuf,
    log: Arc<Mutex<File>>,
}

/// The screen's two sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Screen {
    None,
    Out,
    Error,
}

impl Console {
    pub(super) fn open(folder: &Path) -> Result<Self, SuperviseError> {
        let path = folder.join("launch.log");
        let log = std::fs::create_dir_all(folder)
            .and_then(|()| File::create(&path))
            .map_err(|source| SuperviseError::Write { path, source })?;
        Ok(Self { folder: folder.to_owned(), log: Arc::new(Mutex::new(log)) })
    }

    /// A line of the launcher's own.
    pub(super) fn say(&self, level: &str, who: &str, text: &str) {
        self.line(&format!("[{level}] [{who}]: {text}"), Screen::Error, None);
    }

    /// A new log file for the process `label`. Where it cannot be made, its lines are in `launch.log` all the same.
    pub(super) fn log_of(&self, label: &str) -> Option<Arc<Mutex<File>>> {
        let path = self.folder.join(format!("{label}.log"));
        match File::options().create(true).append(true).open(&path) {
            Ok(file) => Some(Arc::new(Mutex::new(file))),
            Err(error) => {
                self.say("WARN", label, &format!("cannot write {}: {error}", path.display()));
                None
            }
        }
    }

    /// Forwards all lines of `stream` in a thread that holds `alive` until the stream ends, and keeps the last.
    pub(super) fn forward(
        &self,
        stream: impl Read + Send + 'static,
        label: &str,
        screen: Screen,
        own_log: Option<Arc<Mutex<File>>>,
        last_words: Option<LastWords>,
        alive: Sender<()>,
    ) -> std::io::Result<()> {
        let console = self.clone();
        let prefix = format!("[{label}] ");
        std::thread::Builder::new().name(label.to_owned()).spawn(move || {
            let _alive = alive;
            let mut reader = BufReader::new(stream);
            let mut line = Vec::new();
            while matches!(reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line), Ok(length) if length > 0) {
                let text = String::from_utf8_lossy(&line);
                let text = text.trim_end_matches(['\n', '\r']);
                console.line(&format!("{prefix}{text}"), screen, own_log.as_deref());
                if let Some(last_words) = &last_words {
                    last_words.add(text);
                }
                line.clear();
            }
        })?;
        Ok(())
    }

    /// Writes one line everywhere it belongs. A full disk or a closed terminal must not stop the robots' supervisor:
    /// what cannot be written is lost.
    fn line(&self, text: &str, screen: Screen, own_log: Option<&Mutex<File>>) {
        let text = format!("{text}\n");
        for log in std::iter::once(&*self.log).chain(own_log) {
            if let Ok(mut file) = log.lock() {
                let _ = file.write_all(text.as_bytes());
            }
        }
        let _ = match screen {
            Screen::None => Ok(()),
            Screen::Out => std::io::stdout().lock().write_all(text.as_bytes()),
            Screen::Error => std::io::stderr().lock().write_all(text.as_bytes()),
        };
    }
}
