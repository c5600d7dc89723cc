//! The player as a state machine.

use super::keys::{HELP, Key, Keys, RATE_STEP};
use super::publications::Publications;
use super::services::{self, services};
use super::settings::Settings;
use super::tape::Tape;
use super::timeline::Timeline;
use crate::{BagMessage, BagReader};
use std::sync::Arc;
use trench_config::{ConfigError, Parameters};
use trench_core::{ByteStream, Event, Interface, Level, NodeCore, RequestId, RosTime, Sink, Steady, Times};
use trench_msgs::Message;
use trench_msgs::rosbag2_interfaces as msgs;
use trench_msgs::rosgraph_msgs::Clock;

/// Most messages published in one turn: other events want theirs.
const AT_ONCE: usize = 64;
/// The exit code when the bag could not be played to its end.
const FAILED: u8 = 1;

/// Plays a bag.
pub(super) struct Player {
    interface: Interface,
    settings: Settings,
    tape: Tape,
    timeline: Timeline,
    keys: Keys,
    clock: Option<usize>,
    next_clock: Steady,
    played: u64,
    is_over: bool,
}

impl Player {
    /// A player of a bag, given the length of the longest message of each topic. Nothing where there is nothing to play.
    pub(super) fn new(bag: Arc<BagReader>, longest: &[usize], settings: Settings) -> Option<Self> {
        let (first, last) = bag.span()?;
        let nanoseconds = |seconds: f64| (seconds * 1e9) as u64;
        let from = first.saturating_add(nanoseconds(settings.start_offset));
        let to = match settings.playback_duration {
            duration if duration < 0.0 => last,
            duration => from.saturating_add(nanoseconds(duration)).min(last),
        };
        let Publications { advertised, of_topic, clock } = Publications::new(bag.topics(), longest, &settings);
        let interface = Interface {
            publications: advertised,
            services: services(),
            byte_streams: settings.keyboard.then_some(ByteStream::Keyboard).into_iter().collect(),
            ..Interface::default()
        };
        let tape = Tape::new(bag, of_topic, (from, to));
        tape.next_time()?;
        Some(Self {
            interface,
            timeline: Timeline::new(Steady(0), from, settings.rate, settings.start_paused),
            settings,
            tape,
            keys: Keys::default(),
            clock,
            next_clock: Steady(0),
            played: 0,
            is_over: false,
        })
    }

    fn start(&mut self, at: Times, sink: &mut dyn Sink) {
        let (from, to) = self.tape.span();
        let topics = self.tape_topics();
        sink.log(Level::Info, &format!("playing {topics} topics, {:.3} s", to.saturating_sub(from) as f64 * 1e-9));
        if self.settings.keyboard {
            sink.log(Level::Info, HELP);
        }
        self.timeline.jump(at.steady.plus_seconds(self.settings.delay), from);
        self.next_clock = at.steady;
        for (port, message) in self.tape.latched_before(from) {
            publish(port, &message, sink);
        }
    }

    fn tape_topics(&self) -> usize {
        self.interface.publications.len() - usize::from(self.clock.is_some())
    }

    /// Publishes what is due.
    fn wake(&mut self, at: Times, sink: &mut dyn Sink) {
        if self.settings.clock > 0.0 && at.steady >= self.next_clock {
            self.tell_time(self.timeline.now(at.steady), sink);
            self.next_clock = at.steady.plus_seconds(1.0 / self.settings.clock);
        }
        for _ in 0..AT_ONCE {
            let due = self.tape.next_time().and_then(|time| self.timeline.due(time));
            if due.is_none_or(|due| due > at.steady) {
                break;
            }
            self.play_next(sink);
        }
        self.end(at, sink);
    }

    /// Begins again or ends, where the last message was played.
    fn end(&mut self, at: Times, sink: &mut dyn Sink) {
        if self.is_over || self.tape.next_time().is_some() {
            return;
        }
        let problem = self.tape.take_problem();
        if self.settings.is_loop && problem.is_none() {
            return self.seek(at, self.tape.span().0, sink);
        }
        self.is_over = true;
        if let Some(problem) = &problem {
            sink.log(Level::Error, &problem.to_string());
        }
        sink.log(Level::Info, &format!("played {} messages", self.played));
        sink.exit(if problem.is_some() { FAILED } else { 0 });
    }

    /// Publishes the next message, whenever it is due. Whether there was one.
    fn play_next(&mut self, sink: &mut dyn Sink) -> bool {
        let Some((port, message)) = self.tape.take() else { return false };
        if self.settings.clock_topics_all {
            self.tell_time(message.log_time, sink);
        }
        publish(port, &message, sink);
        self.played += 1;
        true
    }

    /// As [`Player::play_next`], with time moved there: while paused.
    fn step(&mut self, at: Times, sink: &mut dyn Sink) -> bool {
        let Some(time) = self.tape.next_time().filter(|_| self.timeline.is_paused()) else { return false };
        self.timeline.jump(at.steady, time);
        let is_played = self.play_next(sink);
        self.end(at, sink);
        is_played
    }

    fn seek(&mut self, at: Times, time: u64, sink: &mut dyn Sink) {
        for (port, message) in self.tape.seek(time) {
            publish(port, &message, sink);
        }
        self.timeline.jump(at.steady, time.max(self.tape.span().0));
    }

    fn tell_time(&self, time: u64, sink: &mut dyn Sink) {
        if let Some(port) = self.clock {
            sink.publish(port, &Clock { clock: RosTime(i64::try_from(time).unwrap_or(i64::MAX)).into() });
        }
    }

    fn pause(&mut self, at: Times, is_paused: bool, sink: &mut dyn Sink) {
        if self.timeline.is_paused() != is_paused {
            self.timeline.pause(at.steady, is_paused);
            sink.log(Level::Info, if is_paused { "paused" } else { "going on" });
        }
    }

    fn set_rate(&mut self, at: Times, rate: f64, sink: &mut dyn Sink) -> bool {
        let is_set = self.timeline.set_rate(at.steady, rate);
        if is_set {
            sink.log(Level::Info, &format!("rate {rate:.3}"));
        }
        is_set
    }

    fn press(&mut self, at: Times, key: Key, sink: &mut dyn Sink) {
        match key {
            Key::TogglePaused => self.pause(at, !self.timeline.is_paused(), sink),
            Key::PlayNext => drop(self.step(at, sink)),
            Key::Faster => drop(self.set_rate(at, self.timeline.rate() * RATE_STEP, sink)),
            Key::Slower => drop(self.set_rate(at, self.timeline.rate() / RATE_STEP, sink)),
        }
    }

    fn serve(&mut self, at: Times, service: usize, id: RequestId, cdr: &[u8], sink: &mut dyn Sink) {
        match service {
            services::PAUSE => {
                self.pause(at, true, sink);
                sink.respond(service, id, &msgs::PauseResponse::default());
            }
            services::RESUME => {
                self.pause(at, false, sink);
                sink.respond(service, id, &msgs::ResumeResponse::default());
            }
            services::TOGGLE_PAUSED => {
                self.pause(at, !self.timeline.is_paused(), sink);
                sink.respond(service, id, &msgs::TogglePausedResponse::default());
            }
            services::IS_PAUSED => {
                sink.respond(service, id, &msgs::IsPausedResponse { paused: self.timeline.is_paused() });
            }
            services::PLAY_NEXT => {
                let success = self.step(at, sink);
                sink.respond(service, id, &msgs::PlayNextResponse { success });
            }
            services::BURST => {
                let asked = msgs::BurstRequest::decode(cdr).map_or(0, |request| request.num_messages);
                let actually_burst = (0..asked).take_while(|_| self.step(at, sink)).count() as u64;
                sink.respond(service, id, &msgs::BurstResponse { actually_burst });
            }
            services::SET_RATE => {
                let rate = msgs::SetRateRequest::decode(cdr).map_or(0.0, |request| request.rate);
                let success = self.set_rate(at, rate, sink);
                sink.respond(service, id, &msgs::SetRateResponse { success });
            }
            services::GET_RATE => {
                sink.respond(service, id, &msgs::GetRateResponse { rate: self.timeline.rate() });
            }
            services::SEEK => {
                let asked = msgs::SeekRequest::decode(cdr).ok().map(|request| RosTime::from(&request.time).0);
                let time = asked.and_then(|time| u64::try_from(time).ok()).filter(|&time| time <= self.tape.span().1);
                if let Some(time) = time {
                    self.seek(at, time, sink);
                }
                sink.respond(service, id, &msgs::SeekResponse { success: time.is_some() });
            }
            services::STOP => {
                sink.respond(service, id, &msgs::StopResponse::default());
                self.is_over = true;
                sink.exit(0);
            }
            _ => {}
        }
    }
}

fn publish(port: usize, message: &BagMessage, sink: &mut dyn Sink) {
    sink.publish_with(port, message.len(), &mut |out| match out.get_mut(..message.len()) {
        Some(room) => {
            room.copy_from_slice(message);
            message.len()
        }
        None => 0,
    });
}

impl NodeCore for Player {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => self.start(at, sink),
            Event::Wakeup => self.wake(at, sink),
            Event::Request { service, id, cdr } => self.serve(at, service, id, cdr, sink),
            Event::Bytes { data, .. } => {
                for &byte in data {
                    if let Some(key) = self.keys.take(byte) {
                        self.press(at, key, sink);
                    }
                }
            }
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        if self.is_over {
            return None;
        }
        let message = self.tape.next_time().and_then(|time| self.timeline.due(time));
        let clock = (self.settings.clock > 0.0).then_some(self.next_clock);
        message.into_iter().chain(clock).min()
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        // Rate and pause have services, all else is fixed at the start.
        Ok(())
    }
}
