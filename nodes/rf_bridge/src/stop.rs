//! The emergency stop: sticky, and cleared by the operator's reset alone.

use std::collections::BTreeMap;

/// Who says what about stopping.
#[derive(Debug, Clone, Default)]
pub(crate) struct EmergencyStop {
    active: bool,
    /// The last word of each publisher, with the order in which they spoke.
    words: BTreeMap<[u8; 16], (u64, bool)>,
    spoken: u64,
}

impl EmergencyStop {
    /// As it was left by an earlier life of the node.
    pub(crate) fn restored(active: bool) -> Self {
        Self { active, ..Self::default() }
    }

    /// Whether robots are held.
    pub(crate) fn active(&self) -> bool {
        self.active
    }

    /// A publisher spoke. Gives whether this begins a stop.
    pub(crate) fn hear(&mut self, publisher: [u8; 16], stop: bool) -> bool {
        self.spoken += 1;
        self.words.insert(publisher, (self.spoken, stop));
        let begins = stop && !self.active;
        self.active |= stop;
        begins
    }

    /// So many publishers are alive: of those known, the ones that have been silent for longest are presumed gone.
    pub(crate) fn writers(&mut self, count: usize) {
        while self.words.len() > count {
            let longest_silent = self.words.iter().min_by_key(|(_, (spoken, _))| *spoken).map(|(gid, _)| *gid);
            if let Some(gid) = longest_silent {
                self.words.remove(&gid);
            }
        }
    }

    /// The operator wants to go on.
    ///
    /// # Errors
    /// While a publisher still says stop.
    pub(crate) fn reset(&mut self) -> Result<(), &'static str> {
        if self.words.values().any(|(_, stop)| *stop) {
            return Err("refused: a publisher of /emergency_stop still says true; let it say false or end it");
        }
        self.active = false;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sticks_until_reset_and_resets_only_when_all_agree() {
        let (button, keyboard) = ([1; 16], [2; 16]);
        let mut stop = EmergencyStop::default();
        assert!(!stop.hear(keyboard, false));
        assert!(stop.hear(button, true));
        assert!(!stop.hear(button, true), "it began before");
        assert!(stop.reset().is_err() && stop.active());
        stop.hear(button, false);
        assert!(stop.active(), "only the reset clears it");
        assert!(stop.reset().is_ok() && !stop.active());
        stop.hear(button, true);
        stop.writers(2);
        assert!(stop.reset().is_err());
        stop.writers(0);
        assert!(stop.active() && stop.reset().is_ok() && !stop.active());
    }
}
