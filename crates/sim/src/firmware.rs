//! The firmware of a robot: obeys commands while they are valid, reports, stops by itself.

use crate::Random;
use crate::greeting::{Greeting, Heard};
use crate::relay::{Relay, Relayed};
use trench_radio::{
    AgeMeter, COUNTER_TICK, Fault, Freshness, Key, MAX_RELAYS, Packet, PacketError, Payload, Ranges, Relaying,
    Telemetry, USUAL_AGE, Wheels,
};

/// A command is obeyed for at most this long, whatever it says, ns.
const AGE_LIMIT: u64 = 80_000_000;

/// Without a packet of the base for this long it asks others to pass its reports on, ns.
const UNHEARD: u64 = 300 * MILLISECOND;

/// Below this voltage the battery is reported as low, mV.
const LOW_BATTERY: u16 = 6800;

/// More steps lost than this between two reports are reported.
const LOST_STEPS: f64 = 8.0;

/// An authentic packet this far behind the last one, steps of the counter, is no relay's copy: somebody replays it.
const REPLAYED: u64 = 100 * MILLISECOND / COUNTER_TICK;

const MILLISECOND: u64 = 1_000_000;

/// What the robot's own sensors say.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sensors {
    /// mV
    pub battery_mv: u16,
    /// Steps told to the left and right motor.
    pub steps: [f64; 2],
    /// Steps lost by both motors together.
    pub lost_steps: f64,
    /// cm
    pub ranges: Ranges,
}

/// The state of a robot's firmware.
#[derive(Debug, Clone)]
pub struct Firmware {
    id: u8,
    key: Option<Key>,
    switched_on: u64,
    /// With a key, until the base has welcomed it.
    greeting: Option<Greeting>,
    freshness: Freshness,
    age: AgeMeter,
    relay: Relay,
    last_relayed: u8,
    received: u64,
    wheels: Wheels,
    obey_until: u64,
    fault: Fault,
    signal_dbm: i8,
    sent: u64,
    lost_steps_reported: f64,
    rejected: u64,
    /// What was heard since the last report of who has no key.
    intrusions: Fault,
}

impl Firmware {
    /// Switched on at `now` (ns). With a key it obeys nobody without, and the base only once that has answered a number
    /// out of `nonces`.
    #[must_use]
    pub fn new(id: u8, key: Option<Key>, now: u64, nonces: Random) -> Self {
        Self {
            id,
            greeting: key.is_some().then(|| Greeting::new(id, nonces)),
            key,
            switched_on: now,
            freshness: Freshness::default(),
            age: AgeMeter::default(),
            relay: Relay::new(id),
            last_relayed: 0,
            received: 0,
            wheels: Wheels::STOP,
            obey_until: now,
            fault: Fault::default(),
            signal_dbm: 0,
            sent: 0,
            lost_steps_reported: 0.0,
            rejected: 0,
            intrusions: Fault::default(),
        }
    }

    /// The radio heard a packet: what is to be sent on, if anything.
    pub fn receive(&mut self, now: u64, bytes: &[u8], signal_dbm: i8) -> Option<Relayed> {
        let authentic = self.key.is_some();
        let packet = match Packet::decode(bytes, self.key.as_ref()) {
            Ok(packet) => packet,
            Err(error) => {
                self.rejected += 1;
                if matches!(error, PacketError::Unauthenticated | PacketError::Tag) {
                    self.intrusions.set(Fault::NOT_AUTHENTIC);
                }
                return None;
            }
        };
        if packet.payload.report().is_some() {
            return self.relay.pass_up(now, &packet, bytes, authentic);
        }
        let newer_stop = match self.greeting.as_mut().map(|greeting| greeting.hear(&packet)) {
            None => None,
            Some(Heard::Nothing) => return None,
            Some(Heard::Stop) => {
                self.fault.set(Fault::EMERGENCY_STOP);
                return None;
            }
            // The base says a stop again as long as it lasts: one that was recorded holds nobody for good.
            Some(Heard::Welcome(newer_stop)) => {
                self.greeting = None;
                if newer_stop.is_none() {
                    self.fault.0 &= !Fault::EMERGENCY_STOP.0;
                }
                newer_stop
            }
        };
        if let Err(stale) = self.freshness.accept(packet.counter, now, authentic) {
            if authentic && stale.last - stale.counter > REPLAYED {
                self.intrusions.set(Fault::REPLAYED);
            }
            // A relay's copy of what it has is as expected.
            self.rejected += u64::from(packet.relayed == 0);
            return None;
        }
        (self.signal_dbm, self.last_relayed) = (signal_dbm, packet.relayed);
        self.received += 1;
        let age = self.age.age(packet.counter, now);
        if let Some(counter) = newer_stop {
            self.freshness.set(counter, now);
        }
        self.hear_base(now, &packet.payload, age.saturating_sub(USUAL_AGE));
        self.relay.pass_down(now, &packet, bytes)
    }

    /// Whether what it hears may be sent on to the base station.
    #[must_use]
    pub fn is_relay(&self, now: u64) -> bool {
        self.relay.is_relay(now)
    }

    /// A packet of the base that is new, `late` ns later than usual.
    fn hear_base(&mut self, now: u64, payload: &Payload, late: u64) {
        match payload {
            Payload::Commands(commands) => {
                let left = (u64::from(commands.validity_ms) * MILLISECOND).saturating_sub(late);
                // What is too old when it comes ends nothing that is still valid.
                let usable = late == 0 || left > 0;
                if let Some(&Some(wheels)) = commands.wheels.get(usize::from(self.id)).filter(|_| usable) {
                    self.obey(now, wheels, left);
                }
            }
            Payload::EmergencyStop(robots) if robots.contains(self.id) => {
                self.fault.set(Fault::EMERGENCY_STOP);
                self.wheels = Wheels::STOP;
            }
            Payload::Reset(robots) if robots.contains(self.id) => {
                self.fault.0 &= !Fault::EMERGENCY_STOP.0;
                self.wheels = Wheels::STOP;
            }
            Payload::EmergencyStop(_)
            | Payload::Reset(_)
            | Payload::Telemetry(_)
            | Payload::Hello { .. }
            | Payload::Welcome(_) => {}
        }
    }

    /// What the motors are told at `now`.
    pub fn wheels(&mut self, now: u64) -> Wheels {
        if now >= self.obey_until && !self.fault.has(Fault::COMMAND_TIMEOUT) {
            self.fault.set(Fault::COMMAND_TIMEOUT);
            self.wheels = Wheels::STOP;
        }
        self.wheels
    }

    /// Packets that were broken, not authentic or not new.
    #[must_use]
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    /// The report of a telemetry slot.
    pub fn report(&mut self, now: u64, sensors: Sensors, out: &mut Vec<u8>) {
        let mut fault = self.fault;
        fault.set(std::mem::take(&mut self.intrusions));
        if sensors.battery_mv < LOW_BATTERY {
            fault.set(Fault::LOW_BATTERY);
        }
        if sensors.lost_steps - self.lost_steps_reported > LOST_STEPS {
            fault.set(Fault::MISSED_STEPS);
        }
        self.lost_steps_reported = sensors.lost_steps;
        let (last_counter, last_at) = self.freshness.last().unwrap_or_default();
        let silence = now.saturating_sub(last_at);
        let telemetry = Telemetry {
            robot: self.id,
            fault,
            last_counter: last_counter as u16,
            last_age_ms: u8::try_from(silence / MILLISECOND).unwrap_or(u8::MAX),
            last_relayed: self.last_relayed,
            received: self.received as u16,
            neighbours: self.relay.neighbours(now),
            battery_mv: sensors.battery_mv,
            signal_dbm: self.signal_dbm,
            steps_left: sensors.steps[0] as i64 as i32,
            steps_right: sensors.steps[1] as i64 as i32,
            uptime_ms: (now.saturating_sub(self.switched_on) / MILLISECOND) as u32,
            ranges: sensors.ranges,
        };
        self.sent += 1;
        let asks = self.last_relayed > 0 || silence > UNHEARD || self.relay.are_wanted(now);
        let relaying = if asks { Relaying::Anyone(MAX_RELAYS as u8) } else { Relaying::Direct };
        // A robot without a clock keeps the number of its starts instead: its counters never go back either.
        let counter = self.switched_on / COUNTER_TICK + self.sent;
        let payload = match &mut self.greeting {
            Some(greeting) => Payload::Hello { nonce: greeting.draw(), report: telemetry },
            None => Payload::Telemetry(telemetry),
        };
        let packet = Packet { relayed: 0, relaying, counter, payload };
        packet.encode(self.key.as_ref(), out);
    }

    fn obey(&mut self, now: u64, wheels: Wheels, validity: u64) {
        self.obey_until = now + validity.min(AGE_LIMIT);
        self.fault.0 &= !Fault::COMMAND_TIMEOUT.0;
        self.wheels = if self.fault.has(Fault::EMERGENCY_STOP) { Wheels::STOP } else { wheels };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_radio::{Commands, RobotSet, Welcome, WheelTimer};

    /// The number that it draws for its next report.
    fn hello(firmware: &mut Firmware, now_ms: u64, key: &Key) -> u64 {
        let mut bytes = Vec::new();
        firmware.report(now_ms * MILLISECOND, Sensors::default(), &mut bytes);
        let Ok(Packet { payload: Payload::Hello { nonce, .. }, .. }) = Packet::decode(&bytes, Some(key)) else {
            unreachable!("who knows no counter says hello");
        };
        nonce
    }

    fn has_stopped(firmware: &mut Firmware) -> bool {
        let mut bytes = Vec::new();
        firmware.report(9000 * MILLISECOND, Sensors::default(), &mut bytes);
        let packet = Packet::decode(&bytes, None).unwrap();
        packet.payload.report().is_some_and(|report| report.fault.has(Fault::EMERGENCY_STOP))
    }

    fn forward() -> Wheels {
        Wheels { left: WheelTimer::from_speed(0.1), right: WheelTimer::from_speed(0.1) }
    }

    fn send(firmware: &mut Firmware, now_ms: u64, counter: u64, payload: Payload, key: Option<&Key>) {
        let mut bytes = Vec::new();
        Packet { relayed: 0, relaying: Relaying::Direct, counter, payload }.encode(key, &mut bytes);
        firmware.receive(now_ms * MILLISECOND, &bytes, -60);
    }

    fn drive(validity_ms: u8) -> Payload {
        let mut commands = Commands { validity_ms, ..Commands::default() };
        commands.wheels[3] = Some(forward());
        Payload::Commands(commands)
    }

    #[test]
    fn stops_by_itself_when_the_validity_ends() {
        for (validity_ms, ends) in [(0, 0), (30, 30), (80, 80), (255, 80)] {
            let mut firmware = Firmware::new(3, None, 0, Random::new(1, 0));
            send(&mut firmware, 1000, 1, drive(validity_ms), None);
            if ends > 0 {
                assert_eq!(firmware.wheels((1000 + ends) * MILLISECOND - 1), forward(), "{validity_ms}");
            }
            assert_eq!(firmware.wheels((1000 + ends) * MILLISECOND), Wheels::STOP, "{validity_ms}");
        }
    }

    #[test]
    fn emergency_stop_is_sticky_until_reset_and_rest_follows_reset() {
        let mut firmware = Firmware::new(3, None, 0, Random::new(1, 0));
        send(&mut firmware, 10, 1, drive(80), None);
        send(&mut firmware, 20, 2, Payload::EmergencyStop(RobotSet::ALL), None);
        send(&mut firmware, 30, 3, drive(80), None);
        assert_eq!(firmware.wheels(31 * MILLISECOND), Wheels::STOP);
        send(&mut firmware, 40, 4, Payload::Reset(RobotSet(1)), None);
        send(&mut firmware, 41, 5, drive(80), None);
        assert_eq!(firmware.wheels(42 * MILLISECOND), Wheels::STOP, "the reset was another robot's");
        send(&mut firmware, 50, 6, Payload::Reset(RobotSet(1 << 3)), None);
        assert_eq!(firmware.wheels(51 * MILLISECOND), Wheels::STOP);
        send(&mut firmware, 60, 7, drive(80), None);
        assert_eq!(firmware.wheels(61 * MILLISECOND), forward());
    }

    #[test]
    fn forged_replayed_and_foreign_packets_do_not_move_it() {
        let key = Key::new([1; 16]);
        let check = |counter, sender: Option<&Key>, rejected, intrusion: Fault| {
            let mut firmware = Firmware::new(3, Some(key.clone()), 0, Random::new(1, 0));
            let welcome = Payload::Welcome(Welcome::new(&[(3, hello(&mut firmware, 5, &key))]));
            send(&mut firmware, 10, 500, welcome, Some(&key));
            send(&mut firmware, 5000, counter, drive(80), sender);
            let moves = firmware.wheels(5001 * MILLISECOND) != Wheels::STOP;
            assert_eq!((moves, firmware.rejected()), (rejected == 0, rejected));
            let told = |firmware: &mut Firmware| {
                let mut bytes = Vec::new();
                firmware.report(5002 * MILLISECOND, Sensors::default(), &mut bytes);
                let Ok(Packet { payload: Payload::Telemetry(report), .. }) = Packet::decode(&bytes, Some(&key)) else {
                    unreachable!("a report is telemetry");
                };
                report.fault.0 & (Fault::NOT_AUTHENTIC.0 | Fault::REPLAYED.0)
            };
            assert_eq!((told(&mut firmware), told(&mut firmware)), (intrusion.0, 0), "told once");
        };
        let (none, forged, replayed) = (Fault::default(), Fault::NOT_AUTHENTIC, Fault::REPLAYED);
        let in_time = 500 + 4990 * MILLISECOND / COUNTER_TICK;
        check(in_time, Some(&key), 0, none);
        check(500, Some(&key), 1, none);
        check(400, Some(&key), 1, replayed);
        check(in_time, Some(&Key::new([2; 16])), 1, forged);
        check(in_time, None, 1, forged);
    }

    #[test]
    fn it_obeys_who_says_its_number_back_and_nobody_before() {
        let key = Key::new([1; 16]);
        let now = 100;
        let check = |answer: &dyn Fn(u64) -> Welcome, sealed: Option<&Key>, later_hellos: u64, obeys: bool| {
            let mut firmware = Firmware::new(3, Some(key.clone()), 0, Random::new(1, 0));
            send(&mut firmware, 1, 400, drive(80), Some(&key));
            assert_eq!(firmware.wheels(2 * MILLISECOND), Wheels::STOP, "recorded, or not");
            let nonce = hello(&mut firmware, 5, &key);
            let others: Vec<u64> = (0..later_hellos).map(|_| hello(&mut firmware, 6, &key)).collect();
            assert!(!others.contains(&nonce), "each hello has its own");
            send(&mut firmware, now - 1, 500, Payload::Welcome(answer(nonce)), sealed);
            send(&mut firmware, now, 501, drive(80), Some(&key));
            assert_eq!(firmware.wheels(now * MILLISECOND) != Wheels::STOP, obeys);
            send(&mut firmware, now + 100, 500, drive(80), Some(&key));
            assert_eq!(firmware.wheels((now + 100) * MILLISECOND), Wheels::STOP, "not above the welcome's counter");
        };
        let right = |nonce| Welcome::new(&[(7, 1), (3, nonce)]);
        check(&right, Some(&key), 0, true);
        check(&right, Some(&key), 1, true);
        check(&right, Some(&key), 2, false);
        check(&right, None, 0, false);
        check(&right, Some(&Key::new([2; 16])), 0, false);
        check(&|nonce| Welcome::new(&[(3, nonce ^ 1)]), Some(&key), 0, false);
        check(&|nonce| Welcome::new(&[(7, nonce)]), Some(&key), 0, false);
    }

    #[test]
    fn a_stop_before_the_welcome_holds_if_it_is_newer_than_that() {
        let key = Key::new([1; 16]);
        for (counter, stays) in [(400, false), (600, true)] {
            let mut firmware = Firmware::new(3, Some(key.clone()), 0, Random::new(1, 0));
            let nonce = hello(&mut firmware, 5, &key);
            send(&mut firmware, 10, counter, Payload::EmergencyStop(RobotSet::ALL), Some(&key));
            assert!(has_stopped(&mut firmware), "stopping is safe");
            send(&mut firmware, 20, 500, Payload::Welcome(Welcome::new(&[(3, nonce)])), Some(&key));
            assert_eq!(has_stopped(&mut firmware), stays);
            send(&mut firmware, 30, 601, drive(80), Some(&key));
            assert_eq!(firmware.wheels(31 * MILLISECOND) == Wheels::STOP, stays);
        }
    }

    #[test]
    fn packets_that_were_held_back_are_obeyed_for_less_or_not_at_all() {
        // How late (ms) beyond the first packet's way, and for how long it is obeyed after that, ms.
        for (late, obeyed) in [(0, 80), (19, 80), (50, 50), (120, 0), (5000, 0)] {
            let mut firmware = Firmware::new(3, None, 0, Random::new(1, 0));
            send(&mut firmware, 0, 1000, drive(0), None);
            send(&mut firmware, 1000 + late, 1000 + 1000 * MILLISECOND / COUNTER_TICK, drive(80), None);
            let moves = |ms: u64| firmware.clone().wheels((1000 + late + ms) * MILLISECOND) != Wheels::STOP;
            assert_eq!(moves(0), obeyed > 0, "{late} ms late");
            assert!(obeyed == 0 || moves(obeyed - 3), "{late} ms late");
            assert!(!moves(obeyed + 3), "{late} ms late");
        }
    }

    #[test]
    fn reports_what_it_received() {
        let mut firmware = Firmware::new(3, None, 0, Random::new(1, 0));
        for counter in [1, 2, 5, 9] {
            send(&mut firmware, counter * 30, counter, drive(80), None);
        }
        let mut bytes = Vec::new();
        let sensors = Sensors { battery_mv: 6000, steps: [-3.7, 9.2], lost_steps: 9.0, ranges: Ranges::default() };
        firmware.report(275 * MILLISECOND, sensors, &mut bytes);
        let Ok(Packet { payload: Payload::Telemetry(telemetry), .. }) = Packet::decode(&bytes, None) else {
            unreachable!("{bytes:?}")
        };
        let expected = Telemetry {
            robot: 3,
            fault: Fault(Fault::LOW_BATTERY.0 | Fault::MISSED_STEPS.0),
            last_counter: 9,
            last_age_ms: 5,
            last_relayed: 0,
            received: 4,
            neighbours: RobotSet::default(),
            battery_mv: 6000,
            signal_dbm: -60,
            steps_left: -3,
            steps_right: 9,
            uptime_ms: 275,
            ranges: Ranges::default(),
        };
        assert_eq!(telemetry, expected);
    }
}
