"""What a fault run does over the network, and how it knows the time of the run."""

import array
import math
import os
import random
import re
import socket
import time
from collections.abc import Callable
from functools import cached_property

# Rate of what is published, Hz.
RATE = 50.0
# Pictures, which are large: one in so many turns, from the second one on, which is of the next hour where turns differ. RustDDS keeps the last 256
# messages of every topic that a process hears (crates/runtime/src/transport/dds/qos.rs): more would be taken for memory that is lost.
PICTURES, SELDOM = "/overhead/image_raw", 101
# Topics that nobody reads, or only where robots have lasers: nobody waits until somebody does.
UNREAD = ("/overhead/camera_info", "/robot1/scan")
# Pixels of the overhead camera (config/cameras/overhead.yaml).
CAMERA = (768, 576)


class Ears:
    """Knows when the run began, and speaks on the network where a fault asks for it."""

    def __init__(self, log: Callable[[], str]):
        self.log, self.t0 = log, None

    @cached_property
    def node(self):
        """A node of our own, made when the first fault needs one."""
        import rclpy

        rclpy.init()
        return rclpy.create_node("faults", enable_rosout=False, start_parameter_services=False)

    def wait_for_start(self, timeout: float) -> None:
        """Until robots move; the next frame is t0."""
        deadline = time.monotonic() + timeout
        while self.t0 is None:
            if time.monotonic() > deadline:
                raise TimeoutError("the run did not start")
            log = self.log()
            started = re.search(r"\[(\d+\.\d+)\] \[leader_assignment\]: Start: started", log)
            # A run that goes on where an earlier life was has no start: the operator says how old it is.
            going_on = re.search(r"\[(\d+\.\d+)\] \[operator\]: t = +(\d+\.\d+) s", log)
            if started:
                self.t0 = float(started.group(1))
            elif going_on:
                self.t0 = float(going_on.group(1)) - float(going_on.group(2))
            time.sleep(0.02)

    def wait_until(self, seconds: float) -> None:
        """Until so long after t0."""
        time.sleep(max(0.0, self.t0 + seconds - time.time()))

    def close(self) -> None:
        """Leaves the network."""
        if "node" in self.__dict__:
            import rclpy

            self.node.destroy_node()
            rclpy.try_shutdown()


def _found(ears: Ears, kind, topic: str):
    """A publisher that others have found: before, it can do neither harm nor good."""
    publisher = ears.node.create_publisher(kind, topic, 10)
    deadline = time.monotonic() + 5.0
    while publisher.get_subscription_count() < 1 and time.monotonic() < deadline:
        time.sleep(0.02)
    # Readers find it when it has found them, or a little later.
    time.sleep(0.3)
    return publisher


def _now(ears: Ears):
    return ears.node.get_clock().now().to_msg()


def _speak(ears: Ears, voices: list, seconds: float, seldom: int = SELDOM) -> float:
    """Publishes on several topics at once: kind, topic and what makes each message (or its bytes)."""
    publishers = [(ears.node.create_publisher(kind, topic, _quality(topic)), make) for kind, topic, make in voices]
    awaited = [publisher for publisher, _ in publishers if publisher.topic_name not in UNREAD]
    deadline = time.monotonic() + 1.0
    while any(publisher.get_subscription_count() < 1 for publisher in awaited) and time.monotonic() < deadline:
        time.sleep(0.02)
    time.sleep(0.3)
    began, end, turn = time.time(), time.monotonic() + seconds, 0
    while time.monotonic() < end:
        for publisher, make in publishers:
            if publisher.topic_name != PICTURES or turn % seldom == 1:
                publisher.publish(make(turn))
        turn += 1
        time.sleep(1.0 / RATE)
    for publisher, _ in publishers:
        ears.node.destroy_publisher(publisher)
    return began


def _quality(topic: str):
    """As readers of the topic ask for it: of latched ones nobody hears a publisher who does not keep its word."""
    from rclpy.qos import DurabilityPolicy, QoSProfile

    latched = topic in ("/run_state", "/assignment", "/formation", "/loop_delay")
    return QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL) if latched else QoSProfile(depth=10)


def _command(stamp, speed: float):
    from geometry_msgs.msg import TwistStamped

    command = TwistStamped()
    command.header.stamp = stamp
    command.twist.linear.x = speed
    return command


def _team(stamp, place: float):
    from trench_msgs.msg import RobotState, TeamState

    team = TeamState()
    team.header.stamp = stamp
    for number in range(1, 5):
        robot = RobotState(name=f"robot{number}", status=RobotState.STATUS_TRACKED)
        robot.x = robot.y = robot.theta = robot.v = place
        team.robots.append(robot)
    return team


def _goals(stamp, place: float):
    from trench_msgs.msg import Goal, Goals

    goals = Goals(epoch=2**63)
    goals.header.stamp = stamp
    for number in range(1, 5):
        goal = Goal(robot=f"robot{number}", remaining=1e9)
        goal.position.x = goal.position.y = place
        goals.goals.append(goal)
    return goals


def _triangle(place: float) -> list:
    from trench_msgs.msg import Point2

    return [Point2(x=place, y=place), Point2(x=place + 0.1, y=place), Point2(x=place, y=place + 0.1)]


def _hulls(stamp, place: float):
    from trench_msgs.msg import ApparentObstacle, ApparentObstacleArray

    hulls = ApparentObstacleArray()
    hulls.header.stamp = stamp
    hulls.obstacles.append(ApparentObstacle(id=1, hull=_triangle(place), members=[1]))
    return hulls


def _obstacles(stamp, place: float):
    from trench_msgs.msg import Obstacle, ObstacleArray

    obstacles = ObstacleArray()
    obstacles.header.stamp = stamp
    obstacles.obstacles.append(Obstacle(id=1, polygon=_triangle(place)))
    return obstacles


def _leader(stamp, place: float):
    from trench_msgs.msg import LeaderState

    leader = LeaderState(robot="robot2")
    leader.header.stamp = stamp
    leader.position.x = leader.position.y = leader.theta = leader.goal_distance = place
    return leader


def _run(stamp, place: float):
    from trench_msgs.msg import RunState

    # Half of these say that nothing runs.
    state = RunState.RUNNING if stamp.nanosec % 2 else RunState.STOPPED
    return RunState(state=state, epoch=2**63)


def _assignment(stamp, place: float):
    from trench_msgs.msg import Assignment, Member

    assignment = Assignment(epoch=2**63, formation_hash=2**63)
    assignment.header.stamp = stamp
    assignment.members = [Member(robot=f"robot{number}", rank=number) for number in range(1, 5)]
    return assignment


def _formation(stamp, place: float):
    from trench_msgs.msg import Formation

    formation = Formation(name="nonsense", hash=2**63)
    formation.header.stamp = stamp
    return formation


def _target(stamp, place: float):
    from nav_msgs.msg import Odometry

    target = Odometry()
    target.header.stamp, target.header.frame_id = stamp, "map"
    target.pose.pose.position.x = target.twist.twist.linear.x = place
    return target


def _link(stamp, place: float):
    from trench_msgs.msg import LinkStatus

    link = LinkStatus(robot="robot2", up=False, loss=place)
    link.header.stamp = stamp
    return link


def _identify(stamp, place: float):
    from trench_msgs.msg import Identify

    identify = Identify(robot="robot1")
    identify.header.stamp = stamp
    return identify


def _delay(stamp, place: float):
    from std_msgs.msg import Float64

    return Float64(data=place)


def _image(stamp, place: float):
    """A black picture: nobody is there any more."""
    from sensor_msgs.msg import Image

    width, height = CAMERA
    pixels = array.array("B", b"\x10\x80" * (width * height))
    image = Image(width=width, height=height, encoding="yuv422_yuy2", step=2 * width, data=pixels)
    image.header.stamp, image.header.frame_id = stamp, "overhead_camera"
    return image


def _lens(stamp, place: float):
    from sensor_msgs.msg import CameraInfo

    width, height = CAMERA
    lens = CameraInfo(width=width, height=height, distortion_model="plumb_bob", d=[place] * 5, k=[place] * 9, p=[place] * 12)
    lens.header.stamp = stamp
    return lens


def _scan(stamp, place: float):
    """A wall around robot1."""
    from sensor_msgs.msg import LaserScan

    scan = LaserScan(angle_increment=math.radians(1.0), range_min=0.1, range_max=3.5)
    scan.ranges = array.array("f", [place if abs(place) < 1e30 else math.inf] * 360)
    scan.header.stamp = stamp
    return scan


def _voices() -> list:
    """What robots are moved by: kind, topic, message from a stamp and a number.

    Who only comes on /emergency_stop has his hand on the button: robots rest until he speaks (docs/timeouts.md), so nobody does here.
    """
    from geometry_msgs.msg import TwistStamped
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import CameraInfo, Image, LaserScan
    from std_msgs.msg import Float64
    from trench_msgs.msg import (
        ApparentObstacleArray,
        Assignment,
        Formation,
        Goals,
        Identify,
        LeaderState,
        LinkStatus,
        ObstacleArray,
        RunState,
        TeamState,
    )

    return [
        (TeamState, "/team_state", _team),
        (Goals, "/goals", _goals),
        (TwistStamped, "/robot1/cmd_vel", _command),
        (ApparentObstacleArray, "/apparent_obstacles", _hulls),
        (ObstacleArray, "/obstacles", _obstacles),
        (LeaderState, "/robot2/leader_state", _leader),
        (RunState, "/run_state", _run),
        (Assignment, "/assignment", _assignment),
        (Formation, "/formation", _formation),
        (Odometry, "/target", _target),
        (LinkStatus, "/robot2/link", _link),
        (Identify, "/identify", _identify),
        (Image, PICTURES, _image),
        (CameraInfo, "/overhead/camera_info", _lens),
        (LaserScan, "/robot1/scan", _scan),
        (Formation, "/set_formation", _formation),
        (Float64, "/loop_delay", _delay),
    ]


def foreign_command(ears: Ears, seconds: float) -> float:
    """Somebody else drives robot1, fast."""
    kind, topic, make = _voices()[2]
    return _speak(ears, [(kind, topic, lambda _: make(_now(ears), 0.25))], seconds)


def second_camera(ears: Ears, seconds: float) -> float:
    """Somebody else's camera, of the same size and on time, shows that nobody is there."""
    voices = [voice for voice in _voices() if voice[1].startswith("/overhead/")]
    return _speak(ears, [(kind, topic, lambda _, make=make: make(_now(ears), 0.0)) for kind, topic, make in voices], seconds, seldom=33)


def not_numbers(ears: Ears, seconds: float) -> float:
    """Somebody else speaks on all topics that move robots, and says no numbers."""
    values = (math.nan, math.inf, -math.inf, 1e300)

    def voice(make):
        return lambda turn: make(_now(ears), values[turn % len(values)])

    return _speak(ears, [(kind, topic, voice(make)) for kind, topic, make in _voices()], seconds)


def past_and_future(ears: Ears, seconds: float) -> float:
    """Somebody else speaks on all topics that move robots, of an hour ago and of the next one."""

    def voice(make):
        def said(turn: int):
            stamp = _now(ears)
            stamp.sec += 3600 if turn % 2 else -3600
            return make(stamp, 0.2)

        return said

    return _speak(ears, [(kind, topic, voice(make)) for kind, topic, make in _voices()], seconds)


def wrong_sizes(ears: Ears, seconds: float) -> float:
    """Somebody else sends bytes that are none of the types that it announces: too short, too long, with lengths of its own."""
    chance = random.Random(2)

    def noise(_):
        return b"\x00\x01\x00\x00" + chance.randbytes(chance.choice([0, 1, 3, 17, 64, 900]))

    # Of a type of one size Fast DDS sends no other.
    return _speak(ears, [(kind, topic, noise) for kind, topic, _ in _voices() if topic != "/loop_delay"], seconds)


def wrong_types(ears: Ears, seconds: float) -> float:
    """Somebody else has another type on all topics that move robots."""
    from std_msgs.msg import String

    # Known as wrong as soon as it is there.
    began = time.time()
    _speak(ears, [(String, topic, lambda _: String(data="x" * 100)) for _, topic, _ in _voices()], seconds)
    return began


def garbage_udp(ears: Ears, seconds: float) -> float:
    """Noise on every DDS port of the domain that a participant may have, its multicast ones too, half of it behind an RTPS header."""
    del ears
    chance = random.Random(1)
    base = 7400 + 250 * int(os.environ["ROS_DOMAIN_ID"])
    ports = [base, base + 1, *range(base + 10, base + 60)]
    places = [*(("127.0.0.1", port) for port in ports), ("239.255.0.1", base), ("239.255.0.1", base + 1)]
    header = b"RTPS\x02\x04\x01\x12" + bytes(12)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        began, end = time.time(), time.monotonic() + seconds
        while time.monotonic() < end:
            for place in places:
                noise = chance.randbytes(chance.randrange(1, 1400))
                sender.sendto(header + noise if chance.random() < 0.5 else noise, place)
            time.sleep(0.005)
    return began


def emergency_stop(ears: Ears, seconds: float) -> float:
    """An emergency stop, which is taken back and reset."""
    import rclpy
    from std_msgs.msg import Bool
    from std_srvs.srv import Trigger

    publisher = _found(ears, Bool, "/emergency_stop")
    began, end = time.time(), time.monotonic() + seconds
    while time.monotonic() < end:
        publisher.publish(Bool(data=True))
        time.sleep(1.0 / RATE)
    for _ in range(5):
        publisher.publish(Bool(data=False))
        time.sleep(1.0 / RATE)
    client = ears.node.create_client(Trigger, "/rf_bridge/reset")
    client.wait_for_service(timeout_sec=2.0)
    answer = client.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(ears.node, answer, timeout_sec=2.0)
    ears.node.destroy_publisher(publisher)
    return began


# Each gives when it began, s, wall clock.
INJECTIONS = {
    function.__name__: function
    for function in (
        foreign_command, second_camera, not_numbers, past_and_future, wrong_sizes, wrong_types, garbage_udp, emergency_stop,
    )
}
