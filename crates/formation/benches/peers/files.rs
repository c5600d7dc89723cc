//! Files for the peers, and where their random contents come from.
use std::error::Error;
use std::fs;
use std::path::PathBuf;

/// A folder, where one was asked for.
pub(crate) struct Files(Option<PathBuf>);

impl Files {
    pub(crate) fn new(folder: Option<String>) -> Result<Self, Box<dyn Error>> {
        let folder = folder.map(PathBuf::from);
        if let Some(folder) = &folder {
            fs::create_dir_all(folder)?;
        }
        Ok(Self(folder))
    }

    /// A text of this name.
    pub(crate) fn text(&self, name: &str, text: &str) -> Result<(), Box<dyn Error>> {
        let Some(folder) = &self.0 else { return Ok(()) };
        Ok(fs::write(folder.join(name), text)?)
    }

    /// Rows of numbers that another program reads back bit for bit.
    pub(crate) fn rows(&self, name: &str, rows: impl Iterator<Item = Vec<f64>>) -> Result<(), Box<dyn Error>> {
        let line = |row: Vec<f64>| row.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(" ");
        let text: Vec<String> = rows.map(line).collect();
        self.text(name, &(text.join("\n") + "\n"))
    }
}

/// A fraction of 1 from a Weyl sequence with a mixer (splitmix64).
pub(crate) fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut mixed = *state;
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}
