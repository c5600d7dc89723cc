//! The device's rhythm, its buffers, and a driver that is fed from files; a real device where there is one.

use super::super::driver::Buffers;
use super::*;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

#[test]
fn a_device_that_is_none_is_looked_for_again() {
    for path in ["/dev/null", "/dev/no-such-camera"] {
        let mut source = DeviceSource::new(path, [768, 576], 30.0, PixelFormat::Jpeg, 0.0);
        source.start(Steady(5));
        let mut look = |nanoseconds| {
            let now = Times { ros: RosTime(0), steady: Steady(nanoseconds) };
            source.take(now, &mut |frame| panic!("{frame:?}")).map_err(|error| error.to_string())
        };
        assert_eq!(look(4), Ok(Taken::NotYet));
        for due in [5, 500_000_005] {
            let error = look(due).unwrap_err();
            assert!(error.starts_with(&format!("cannot open {path}: ")), "{error}");
            assert_eq!(look(due + 400_000_000), Ok(Taken::NotYet));
        }
    }
}

/// What becomes of a buffer: size, step, encoding and first bytes of the frame, or the reason why there is none.
fn handed_over(filled: &[u8], step: u32, format: PixelFormat) -> Result<(u32, u32, Encoding, Vec<u8>), String> {
    let mut frame = None;
    let exposed = RosTime(7);
    let taken = hand_over(filled, exposed, step, format, [16, 8], &mut |given| {
        given.check(Some([16, 8]), 4096).unwrap();
        assert_eq!(given.exposed, exposed);
        frame = Some((given.width, given.step, given.encoding, given.pixels[..3].to_vec()));
    });
    taken.map_err(|error| error.to_string()).map(|taken| {
        assert_eq!(taken, Taken::Frame);
        frame.unwrap()
    })
}

#[test]
fn buffers_become_frames() {
    let raw = PixelFormat::Raw;
    // Drivers' buffers are longer than their frames, and rows may be padded.
    assert_eq!(handed_over(&[9; 512], 32, raw(Encoding::Yuv422Yuy2)), Ok((16, 32, Encoding::Yuv422Yuy2, vec![9; 3])));
    assert_eq!(handed_over(&[9; 512], 64, raw(Encoding::Rgb8)), Ok((16, 64, Encoding::Rgb8, vec![9; 3])));
    assert_eq!(
        handed_over(&[9; 511], 64, raw(Encoding::Bgr8)),
        Err("a frame has 511 bytes, 512 are needed".to_owned())
    );
    let mut jpeg = std::io::Cursor::new(Vec::new());
    let picture = image::RgbImage::from_pixel(16, 8, image::Rgb([90; 3]));
    picture.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
    let jpeg = jpeg.into_inner();
    assert_eq!(handed_over(&jpeg, 0, PixelFormat::Jpeg), Ok((16, 48, Encoding::Rgb8, vec![90; 3])));
    assert!(handed_over(&jpeg[..20], 0, PixelFormat::Jpeg).unwrap_err().starts_with("a frame: "));
}

/// How many of the frames that arrive every `actual` (s) in ten seconds are taken, by a device that says `told`.
fn taken(told: f64, actual: f64, hold_up: Option<f64>) -> (u32, u32) {
    let mut rhythm = Rhythm::new(Steady(0), told);
    let (mut now, mut taken, mut looks, mut held_up) = (Steady(0), 0, 0, hold_up);
    let mut arrivals = (1..).map(|frame| Steady((1e9 * actual * f64::from(frame)) as u64)).peekable();
    while now < Steady(10_000_000_000) {
        looks += 1;
        let arrival = arrivals.next_if(|arrival| *arrival <= now);
        let (is_known, next) = rhythm.look(now, arrival.is_some());
        if is_known {
            taken += 1;
            assert!(now.seconds_since(arrival.unwrap()) <= KNOWN, "stamped at {now:?}: {arrival:?}");
        }
        now = next.max(Steady(now.0 + 20_000));
        if let Some(seconds) = held_up.take_if(|_| now > Steady(5_000_000_000)) {
            now = now.plus_seconds(seconds);
        }
    }
    (taken, looks)
}

#[test]
fn arrivals_are_known_whatever_the_device_says_of_its_rate() {
    let check = |told: f64, actual: f64, hold_up: Option<f64>, dropped: u32| {
        let (taken, looks) = taken(told, actual, hold_up);
        let frames = (10.0 / actual) as u32;
        assert!(taken + dropped >= frames - 1, "{taken} of {frames}, told {told} s, are {actual} s apart");
        assert!(looks < 12 * frames + 200, "{looks} looks for {frames} frames");
    };
    check(0.033, 0.033, None, 0);
    check(0.033, 0.0333, None, 0);
    check(0.033, 0.04, None, 0);
    check(0.04, 0.033, None, 1);
    check(0.1, 0.0167, None, 12);
    check(0.033, 0.0333, Some(0.15), 6);
}

/// A driver whose device sends a file's bytes as each of its frames, `period` (s) apart by the test's clock.
struct FromFiles {
    folder: PathBuf,
    step: u32,
    period: f64,
    clock: Arc<AtomicU64>,
    /// Frames until the device is pulled out; how often it was opened.
    lasts: u64,
    opened: Arc<AtomicU64>,
}

struct Files {
    frames: Vec<PathBuf>,
    next: u64,
    opened_at: u64,
    period: f64,
    clock: Arc<AtomicU64>,
    lasts: u64,
}

impl Driver for FromFiles {
    fn open(&self, _: &str, _: Wanted, _: &Controls) -> io::Result<Streaming> {
        self.opened.fetch_add(1, Ordering::Relaxed);
        let mut frames: Vec<PathBuf> = std::fs::read_dir(&self.folder)?.map(|entry| entry.unwrap().path()).collect();
        frames.sort();
        let (clock, opened_at) = (Arc::clone(&self.clock), self.clock.load(Ordering::Relaxed));
        let files = Files { frames, next: 0, opened_at, period: self.period, clock, lasts: self.lasts };
        Ok(Streaming { buffers: Box::new(files), step: self.step, period: self.period })
    }
}

impl Buffers for Files {
    fn is_ready(&self) -> io::Result<bool> {
        if self.next == self.lasts {
            return Err(io::Error::from_raw_os_error(19));
        }
        let due = self.opened_at + (1e9 * self.period * (self.next + 1) as f64) as u64;
        Ok(self.clock.load(Ordering::Relaxed) >= due)
    }

    fn take(&mut self, show: &mut dyn FnMut(&[u8], bool)) -> io::Result<()> {
        let file = &self.frames[self.next as usize % self.frames.len()];
        self.next += 1;
        show(&std::fs::read(file)?, file.extension().is_some_and(|extension| extension == "damaged"));
        Ok(())
    }
}

/// Runs a source until `seconds` have passed; what it gave (exposure, encoding, first byte), and what it complained of.
fn run(source: &mut DeviceSource, clock: &AtomicU64, seconds: f64) -> (Vec<(f64, Encoding, u8)>, Vec<String>) {
    let (mut frames, mut complaints) = (Vec::new(), Vec::new());
    source.start(Steady(0));
    while let Some(next) = source.next_look().filter(|next| next.0 as f64 <= 1e9 * seconds) {
        let now = next.0.max(clock.load(Ordering::Relaxed) + 1000);
        clock.store(now, Ordering::Relaxed);
        let times = Times { ros: RosTime(now as i64), steady: Steady(now) };
        let taken = source.take(times, &mut |frame| {
            frame.check(Some([16, 8]), 16 * 8 * 3).unwrap();
            frames.push((frame.exposed.0 as f64 * 1e-9, frame.encoding, frame.pixels[0]));
        });
        complaints.extend(taken.err().map(|error| error.to_string()));
    }
    (frames, complaints)
}

#[test]
fn frames_of_a_driver_that_is_fed_from_files_are_stamped_at_exposure_and_the_device_may_vanish() {
    let folder = tempfile::tempdir().unwrap();
    for (name, byte) in [("0.raw", 10), ("1.raw", 20), ("2.damaged", 30), ("3.raw", 40)] {
        std::fs::write(folder.path().join(name), vec![byte; 512]).unwrap();
    }
    let (clock, opened) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicU64::new(0)));
    let format = PixelFormat::Raw(Encoding::Yuv422Yuy2);
    let mut source = DeviceSource::new("camera", [16, 8], 30.0, format, 0.02);
    source.driver = Box::new(FromFiles {
        folder: folder.path().to_owned(),
        step: 32,
        period: 1.0 / 30.0,
        clock: Arc::clone(&clock),
        lasts: 31,
        opened: Arc::clone(&opened),
    });
    let (frames, complaints) = run(&mut source, &clock, 3.0);
    // 31 frames a second of its life and half a second of being away, twice; one of four is damaged.
    assert_eq!(opened.load(Ordering::Relaxed), 2, "{complaints:?}");
    let damaged = complaints.iter().filter(|text| text.contains("a frame is damaged")).count();
    let vanished = complaints.iter().filter(|text| text.starts_with("camera broke: No such device")).count();
    assert_eq!((frames.len(), damaged, vanished), (46, 16, 2), "{complaints:?}");
    for (exposed, encoding, byte) in &frames {
        assert!(*encoding == Encoding::Yuv422Yuy2 && [10, 20, 40].contains(byte));
        // The first life begins at zero: 0.02 s after each exposure the frame was there, known to half a millisecond.
        let late = (exposed + 0.02) * 30.0;
        assert!(*exposed > 1.1 || (late - late.round()).abs() < 30.0 * 0.0006, "{exposed}");
    }
}

#[test]
fn jpeg_frames_of_a_driver_that_is_fed_from_files_are_decoded() {
    let folder = tempfile::tempdir().unwrap();
    let picture = image::RgbImage::from_pixel(16, 8, image::Rgb([90; 3]));
    picture.save(folder.path().join("0.jpg")).unwrap();
    std::fs::write(folder.path().join("1.jpg"), b"no picture").unwrap();
    let clock = Arc::new(AtomicU64::new(0));
    let mut source = DeviceSource::new("camera", [16, 8], 25.0, PixelFormat::Jpeg, 0.0);
    source.driver = Box::new(FromFiles {
        folder: folder.path().to_owned(),
        step: 0,
        period: 0.04,
        clock: Arc::clone(&clock),
        lasts: 1000,
        opened: Arc::default(),
    });
    let (frames, complaints) = run(&mut source, &clock, 0.5);
    assert_eq!((frames.len(), complaints.len()), (6, 6), "{complaints:?}");
    assert!(frames.iter().all(|(_, encoding, byte)| (*encoding, *byte) == (Encoding::Rgb8, 90)));
}

/// A camera, or v4l2loopback into which another program writes (`ffmpeg -re -stream_loop -1 -i FILM -pix_fmt yuyv422 -f v4l2
/// DEVICE`): TRENCH_V4L2 names it, TRENCH_V4L2_SIZE its size (640x480 if not said). scripts/acceptance runs it where there is one.
#[test]
#[ignore = "needs a V4L2 device, named by TRENCH_V4L2: this kernel may have none"]
fn a_real_device_sends_frames_at_its_rate() {
    let path = std::env::var("TRENCH_V4L2").expect("TRENCH_V4L2 names a device, for example /dev/video0");
    let size = std::env::var("TRENCH_V4L2_SIZE").unwrap_or_else(|_| "640x480".to_owned());
    let (width, height) = size.split_once('x').expect("a size such as 640x480");
    let size = [width, height].map(|side| side.parse().unwrap());
    let mut source = DeviceSource::new(&path, size, 30.0, PixelFormat::Raw(Encoding::Yuv422Yuy2), 0.0);
    let begin = std::time::Instant::now();
    source.start(Steady(0));
    let mut exposed = Vec::new();
    while exposed.len() < 90 {
        let now = begin.elapsed();
        assert!(now.as_secs() < 20, "{} frames in 20 s", exposed.len());
        let now = now.as_nanos() as u64;
        let times = Times { ros: RosTime(now as i64), steady: Steady(now) };
        let most = source.most_bytes();
        let taken = source.take(times, &mut |frame| {
            frame.check(Some(size), most).unwrap();
            exposed.push(frame.exposed.0);
        });
        taken.unwrap();
        let wait = source.next_look().map_or(0, |next| next.0.saturating_sub(begin.elapsed().as_nanos() as u64));
        std::thread::sleep(std::time::Duration::from_nanos(wait));
    }
    let period = (exposed[89] - exposed[10]) as f64 * 1e-9 / 79.0;
    println!("{path}: 90 frames, {:.2} a second", 1.0 / period);
    assert!(exposed.is_sorted() && (1.0 / 130.0..1.0 / 4.0).contains(&period), "{period} s from frame to frame");
}
