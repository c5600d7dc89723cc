//! A folder of images, one frame each, at a given rate.

use super::decode::{self, decode};
use super::pace::Pace;
use super::{FrameSource, SourceError, Taken, natural_order};
use crate::frame::Frame;
use image::DynamicImage;
use std::path::{Path, PathBuf};
use std::{fs, io};
use trench_core::{Steady, Times};

/// Images of a folder in the natural order of their names.
pub struct FolderSource {
    files: Vec<PathBuf>,
    most_bytes: usize,
    /// Seconds from one frame to the next.
    period: f64,
    /// Whether the first follows the last.
    repeat: bool,
    /// Seconds from the middle of the exposure to the frame's arrival.
    exposure_delay: f64,
    pace: Pace,
    /// Frames that were due so far.
    count: u64,
    /// The next one, decoded while there is time.
    next: Option<Result<DynamicImage, SourceError>>,
}

/// What of a file's name says that it is an image.
const EXTENSIONS: [&str; 3] = ["png", "jpg", "jpeg"];

impl FolderSource {
    /// The images of `folder`, `rate` (1/s) of them.
    ///
    /// # Errors
    /// When the folder cannot be read, has no images, or the first of them is none.
    pub fn open(folder: &Path, rate: f64, repeat: bool, exposure_delay: f64) -> Result<Self, String> {
        let files = images(folder).map_err(|error| format!("cannot be read: {error}"))?;
        let Some(first) = files.first() else { return Err("holds no .png, .jpg or .jpeg files".to_owned()) };
        let (width, height) =
            image::image_dimensions(first).map_err(|error| format!("{}: {error}", first.display()))?;
        let most_bytes = 3 * width as usize * height as usize;
        let period = 1.0 / rate;
        let mut source =
            Self { files, most_bytes, period, repeat, exposure_delay, pace: Pace::default(), count: 0, next: None };
        source.next = source.load();
        Ok(source)
    }

    /// The image after `count` others, if there is one.
    fn load(&self) -> Option<Result<DynamicImage, SourceError>> {
        let files = self.files.len() as u64;
        let index = if self.repeat { self.count % files } else { self.count };
        let file = self.files.get(usize::try_from(index).ok()?)?;
        let name = file.display().to_string();
        let bytes = fs::read(file).map_err(|error| SourceError::Frame(format!("{name}: {error}")));
        Some(bytes.and_then(|bytes| decode(&bytes, &name)))
    }

    fn due(&self) -> Steady {
        self.pace.due(self.count as f64 * self.period)
    }
}

fn images(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut named = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        if EXTENSIONS.iter().any(|known| known.eq_ignore_ascii_case(extension))
            && let Some(name) = path.file_name()
        {
            named.push((name.to_string_lossy().into_owned(), path));
        }
    }
    named.sort_by(|(a, _), (b, _)| natural_order::compare(a, b));
    Ok(named.into_iter().map(|(_, path)| path).collect())
}

impl FrameSource for FolderSource {
    fn most_bytes(&self) -> usize {
        self.most_bytes
    }

    fn start(&mut self, at: Steady) {
        self.pace.start(at);
    }

    fn take(&mut self, now: Times, give: &mut dyn FnMut(Frame<'_>)) -> Result<Taken, SourceError> {
        let Some(next) = &self.next else { return Ok(Taken::End) };
        let due = self.due();
        let Some(arrival) = self.pace.arrival(due, now) else { return Ok(Taken::NotYet) };
        let taken = match next {
            Ok(image) => {
                give(decode::frame(image, arrival.plus_seconds(-self.exposure_delay)));
                Ok(Taken::Frame)
            }
            Err(error) => Err(error.clone()),
        };
        self.count += 1;
        self.next = self.load();
        taken
    }

    fn next_look(&self) -> Option<Steady> {
        self.next.as_ref().map(|_| self.due())
    }
}
