"""A bag of a fault run as series over time: ground truth, commands, diagnostics."""

import bisect
import math
import struct
from collections.abc import Callable
from pathlib import Path

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from launched import IMAGES

# m/s, below which a robot stands.
STANDS = 0.005
# rad/s, below which it does not turn.
TURNS = 0.1
# m, of a robot from its goal point in a formation that stands.
NEAR = 0.04
# From which on goals are not of our assignment.
FOREIGN_EPOCH = 2**62


class Series:
    """Values over time."""

    def __init__(self):
        self.times, self.values = [], []

    def add(self, at: float, value) -> None:
        """Takes the next."""
        self.times.append(at)
        self.values.append(value)

    def between(self, start: float, end: float) -> list:
        """Pairs of time and value."""
        first, last = bisect.bisect_left(self.times, start), bisect.bisect_right(self.times, end)
        return list(zip(self.times[first:last], self.values[first:last]))

    def at(self, time: float):
        """The last value up to then."""
        index = bisect.bisect_right(self.times, time) - 1
        return self.values[index] if index >= 0 else None


def seconds(stamp) -> float:
    """Of a builtin_interfaces/Time."""
    return stamp.sec + 1e-9 * stamp.nanosec


class Run:
    """A bag as series. With `clocks` that jump, stamps are off by whole hours, which are taken out."""

    def __init__(self, bag: Path, clocks: bool = False):
        self.clocks = clocks
        self.truth: dict[str, Series] = {}
        self.commands: dict[str, Series] = {}
        # Stamps of all commands of the robots' own controllers, in the order in which they came, s.
        self.stamps: dict[str, Series] = {}
        # Of each robot in each assignment: its queue, its rank and whom it follows.
        self.assignments = Series()
        # How far each robot is from its segment, m, by its own word; infinitely where it has none.
        self.segments: dict[str, Series] = {}
        # Of each robot's command link: whether it is up, the share of packets of the last second that were missed, hops.
        self.links: dict[str, Series] = {}
        # Ages of images that came, s.
        self.images = Series()
        self.goals = Series()
        self.team = Series()
        self.diagnostics: list[tuple[float, str, bytes]] = []
        # When they were said, by their own word.
        self.said: list[float] = []
        self.contacts: list[tuple[float, str]] = []
        self.log_times: list[float] = []
        self.t0 = None
        self.stopped: float | None = None
        self.bed_faults: list[tuple[float, str]] = []
        for file in sorted(bag.glob("*.mcap")):
            with open(file, "rb") as stream:
                decoders: dict[int, Callable] = {}
                for schema, channel, message in make_reader(stream).iter_messages():
                    decoder = decoders.get(schema.id) or DecoderFactory().decoder_for(channel.message_encoding, schema)
                    decoders[schema.id] = decoder
                    try:
                        value = decoder(message.data)
                    except (struct.error, ValueError):
                        # A fault may have put there what is no message.
                        continue
                    self._take(channel.topic, 1e-9 * message.log_time, value)

    def _time(self, stamp, at: float) -> float:
        time = seconds(stamp)
        return time - 3600.0 * round((time - at) / 3600.0) if self.clocks else time

    def _take(self, topic: str, at: float, message) -> None:
        parts = topic.strip("/").split("/")
        if topic.startswith("/ground_truth/") and parts[-1] == "odom":
            pose, twist = message.pose.pose, message.twist.twist
            state = (pose.position.x, pose.position.y, math.hypot(twist.linear.x, twist.linear.y), twist.angular.z)
            self.truth.setdefault(parts[1], Series()).add(self._time(message.header.stamp, at), state)
            self.log_times.append(at)
        elif topic == "/ground_truth/contacts":
            self.contacts += [(self._time(message.header.stamp, at), status.message) for status in message.status]
        elif parts[-1] == "cmd_vel":
            # What strangers say (inject.py) does not drive: nobody may count it as a reason why a robot moves.
            if message.header.frame_id != f"{parts[0]}/base_link":
                return
            self.commands.setdefault(parts[0], Series()).add(at, (message.twist.linear.x, message.twist.angular.z))
            self.stamps.setdefault(parts[0], Series()).add(at, self._time(message.header.stamp, at))
        elif parts[-1] == "leader_state":
            distance = message.segment_distance if message.rank > 0 else math.inf
            self.segments.setdefault(message.robot, Series()).add(self._time(message.header.stamp, at), distance)
        elif parts[-1] == "link":
            # Strangers say what is no number (inject.py).
            if math.isfinite(message.loss):
                self.links.setdefault(message.robot, Series()).add(at, (message.up, message.loss, message.hops))
        elif topic == "/assignment":
            if message.epoch < FOREIGN_EPOCH:
                self.assignments.add(at, {member.robot: (member.queue, member.rank, member.leader) for member in message.members})
        elif topic == IMAGES:
            self.images.add(at, at - self._time(message.header.stamp, at))
        elif topic == "/goals":
            if message.epoch < FOREIGN_EPOCH:
                goals = {goal.robot: (goal.position.x, goal.position.y) for goal in message.goals}
                self.goals.add(self._time(message.header.stamp, at), goals)
        elif topic == "/run_state" and message.epoch >= FOREIGN_EPOCH:
            return
        elif topic == "/run_state" and message.state == 3:
            self.stopped = self.stopped or at
        elif topic == "/run_state" and message.state == 2 and seconds(message.t0) > 0.0:
            self.t0 = self.t0 or self._time(message.t0, at)
        elif topic == "/diagnostics":
            for status in message.status:
                level = status.level if isinstance(status.level, bytes) else bytes([status.level])
                self.diagnostics.append((at, f"{status.name}: {status.message}", level))
                self.said.append(self._time(message.header.stamp, at))
                if status.name.endswith("testbed: faults"):
                    self.bed_faults.append((at, status.message))

    def bed_window(self, kind: str, nth: int) -> tuple[float, float] | None:
        """When the nth fault of a kind was in force, as the bed says."""
        windows, since = [], None
        for at, message in self.bed_faults:
            active = kind in message.split(", ")
            if active and since is None:
                since = at
            elif not active and since is not None:
                windows.append((since, at))
                since = None
        return windows[nth] if nth < len(windows) else None

    def distance(self, robot: str, at: float) -> float | None:
        """Of a robot from its goal point."""
        goals, state = self.goals.at(at), self.truth[robot].at(at)
        if not goals or robot not in goals or state is None:
            return None
        return math.hypot(goals[robot][0] - state[0], goals[robot][1] - state[1])

    def goal_speed(self, robot: str, at: float) -> float:
        """Of a robot's goal point, m/s; none stands still of whom nothing is said."""
        ways = [(time, goals[robot]) for time, goals in self.goals.between(at - 0.2, at) if robot in goals]
        if len(ways) < 2:
            return math.inf
        (began, start), (ended, end) = ways[0], ways[-1]
        return math.dist(start, end) / (ended - began)

    def nearest(self, robot: str, start: float, end: float) -> float:
        """How near the middle of another robot comes to that of this one, m."""
        others = [series for name, series in self.truth.items() if name != robot]
        return min((math.dist(state[:2], there[:2]) for at, state in self.truth[robot].between(start, end) for series in others if (there := series.at(at))), default=math.inf)
