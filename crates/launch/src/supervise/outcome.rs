//! How a run ended.

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// All processes finished with 0, or ended by the SIGINT that ended the run.
    Clean,
    /// The process whose end was to end the run (`on_exit: shutdown`) ended with this code (128 + n for signal n).
    Goal {
        /// Its exit code.
        code: u8,
    },
    /// A node refused its command line or configuration with this exit code; the others were told to end.
    Refused {
        /// Its exit code.
        code: u8,
    },
    /// A process that matters was given up, and the alarm called, whatever others ended with.
    Stopped,
    /// A process failed, crashed again and again, or had to be killed; there was no process to decide.
    Failed,
    /// A signal ended the run before the process that decides did.
    Interrupted,
}

impl Outcome {
    /// The exit code of `trench launch`: 0 for [`Self::Clean`], the process's own for [`Self::Goal`] and [`Self::Refused`], 12
    /// for [`Self::Stopped`], 1 for [`Self::Failed`], 130 for [`Self::Interrupted`].
    #[must_use]
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Clean => 0,
            Self::Goal { code } | Self::Refused { code } => code,
            Self::Stopped => 12,
            Self::Failed => 1,
            Self::Interrupted => 130,
        }
    }
}
