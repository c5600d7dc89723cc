//! The images of a bag, at the spacing at which they were recorded.

use super::decode::{self, decode};
use super::pace::Pace;
use super::{FrameSource, SourceError, Taken};
use crate::frame::{Encoding, Frame};
use std::path::Path;
use std::sync::Arc;
use trench_bag::{BagMessage, BagReader, Messages, Topic};
use trench_core::{RosTime, Steady, Times};
use trench_msgs::Message;
use trench_msgs::sensor_msgs::{CompressedImage, Image, ImageView};

/// Older frames than this at their recording, s, have a stamp of another clock.
const OLDEST: f64 = 1.0;

/// One topic of a bag.
pub struct BagSource {
    bag: Arc<BagReader>,
    topic: usize,
    compressed: bool,
    messages: Messages<Arc<BagReader>>,
    repeat: bool,
    most_bytes: usize,
    pace: Pace,
    /// Log time that counts as the start of this round, ns.
    origin: u64,
    /// Log times of the last frame and of the one before it, ns.
    last: [u64; 2],
    next: Option<Result<BagMessage, SourceError>>,
}

impl BagSource {
    /// The images on `topic` of the bag at `path`.
    ///
    /// # Errors
    /// When there is no bag, no such topic, or the topic has no images.
    pub fn open(path: &Path, topic: &str, repeat: bool) -> Result<Self, String> {
        let bag = BagReader::open(path).map_err(|error| error.to_string())?;
        let is_image =
            |topic: &Topic| [Image::TYPE.name, CompressedImage::TYPE.name].contains(&topic.type_name.as_str());
        let Some(index) = bag.topic(topic).filter(|index| is_image(&bag.topics()[*index])) else {
            let names: Vec<&str> =
                bag.topics().iter().filter(|topic| is_image(topic)).map(|topic| topic.name.as_str()).collect();
            return Err(format!("has no images on {topic}; it has images on: {}", names.join(" ")));
        };
        let compressed = bag.topics()[index].type_name == CompressedImage::TYPE.name;
        let bag = Arc::new(bag);
        let mut source = Self {
            topic: index,
            compressed,
            messages: bag.messages_from(0),
            bag,
            repeat,
            most_bytes: 0,
            pace: Pace::default(),
            origin: 0,
            last: [0, 0],
            next: None,
        };
        source.next = source.following();
        let first = match &source.next {
            Some(Ok(first)) => first,
            Some(Err(error)) => return Err(error.to_string()),
            None => return Err(format!("has no message on {topic}")),
        };
        source.origin = first.log_time;
        source.last = [first.log_time; 2];
        source.most_bytes = source.bytes_of(first)?;
        Ok(source)
    }

    fn bytes_of(&self, message: &BagMessage) -> Result<usize, String> {
        let mut bytes = 0;
        self.give(message, RosTime(0), &mut |frame| bytes = frame.pixels.len()).map_err(|error| error.to_string())?;
        Ok(bytes)
    }

    /// The next message of the topic in this round.
    fn following(&mut self) -> Option<Result<BagMessage, SourceError>> {
        self.messages
            .find(|message| message.as_ref().map_or(true, |message| message.topic == self.topic))
            .map(|message| message.map_err(|error| SourceError::Frame(error.to_string())))
    }

    fn advance(&mut self) {
        if let Some(Ok(message)) = &self.next {
            self.last = [message.log_time, self.last[0]];
        }
        self.next = self.following();
        if self.next.is_none() && self.repeat {
            // The first follows the last as the last followed the one before.
            let [last, before] = self.last;
            let round = self.offset(last.saturating_add(last.saturating_sub(before)));
            self.pace.start(self.pace.due(round));
            self.messages = self.bag.messages_from(0);
            self.next = self.following();
            if let Some(Ok(first)) = &self.next {
                self.last = [first.log_time; 2];
            }
        }
    }

    /// Seconds from the first message of a round to `log_time`.
    fn offset(&self, log_time: u64) -> f64 {
        log_time.saturating_sub(self.origin) as f64 * 1e-9
    }

    fn due(&self) -> Steady {
        match &self.next {
            Some(Ok(message)) => self.pace.due(self.offset(message.log_time)),
            _ => Steady(0),
        }
    }

    /// Hands the frame in `message` on, its stamp as much before `arrival` as it was at the recording.
    fn give(&self, message: &BagMessage, arrival: RosTime, give: &mut dyn FnMut(Frame<'_>)) -> Result<(), SourceError> {
        let wrong = |problem: String| SourceError::Frame(format!("a message of the bag: {problem}"));
        let exposed = |stamp: RosTime| {
            let age = RosTime(message.log_time as i64).seconds_since(stamp);
            arrival.plus_seconds(if (0.0..OLDEST).contains(&age) { -age } else { 0.0 })
        };
        if self.compressed {
            let packed = CompressedImage::decode(message).map_err(|error| wrong(error.to_string()))?;
            let image = decode(&packed.data, "a message of the bag")?;
            give(decode::frame(&image, exposed(RosTime::from(&packed.header.stamp))));
            return Ok(());
        }
        let image = ImageView::decode(message).map_err(|error| wrong(error.to_string()))?;
        let encoding = Encoding::from_name(image.encoding).ok_or_else(|| {
            wrong(format!("the encoding is {:?}, it must be rgb8, bgr8 or yuv422_yuy2", image.encoding))
        })?;
        give(Frame {
            exposed: exposed(RosTime::from(&image.header.stamp)),
            width: image.width,
            height: image.height,
            step: image.step,
            encoding,
            pixels: image.data,
        });
        Ok(())
    }
}

impl FrameSource for BagSource {
    fn most_bytes(&self) -> usize {
        self.most_bytes
    }

    fn start(&mut self, at: Steady) {
        self.pace.start(at);
    }

    fn take(&mut self, now: Times, give: &mut dyn FnMut(Frame<'_>)) -> Result<Taken, SourceError> {
        let due = self.due();
        let taken = match &self.next {
            None => return Ok(Taken::End),
            Some(Ok(message)) => {
                let Some(arrival) = self.pace.arrival(due, now) else { return Ok(Taken::NotYet) };
                self.give(message, arrival, give).map(|()| Taken::Frame)
            }
            Some(Err(error)) => Err(error.clone()),
        };
        self.advance();
        taken
    }

    fn next_look(&self) -> Option<Steady> {
        self.next.as_ref().map(|_| self.due())
    }
}
