"""What a fault run does over the network, and how it knows the time of the run."""

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
        """Until leader_assignment says that robots move; the next frame is t0."""
        deadline = time.monotonic() + timeout
        while self.t0 is None:
            if time.monotonic() > deadline:
                raise TimeoutError("the run did not start")
            started = re.search(r"\[(\d+\.\d+)\] \[leader_assignment\]: Start: started", self.log())
            self.t0 = float(started.group(1)) if started else None
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


def _publish(ears: Ears, kind, topic: str, make, seconds: float) -> float:
    publisher = _found(ears, kind, topic)
    began, end = time.time(), time.monotonic() + seconds
    while time.monotonic() < end:
        publisher.publish(make())
        time.sleep(1.0 / RATE)
    ears.node.destroy_publisher(publisher)
    return began


def _now(ears: Ears):
    return ears.node.get_clock().now().to_msg()


def foreign_command(ears: Ears, seconds: float) -> float:
    """Somebody else drives robot1, fast."""
    from geometry_msgs.msg import TwistStamped

    def make():
        command = TwistStamped()
        command.header.stamp = _now(ears)
        command.twist.linear.x = 0.25
        return command

    return _publish(ears, TwistStamped, "/robot1/cmd_vel", make, seconds)


def nan_team_state(ears: Ears, seconds: float) -> float:
    """Somebody else says where robots are: nowhere."""
    from trench_msgs.msg import RobotState, TeamState

    def make():
        team = TeamState()
        team.header.stamp = _now(ears)
        for number in range(1, 5):
            robot = RobotState(name=f"robot{number}", status=RobotState.STATUS_TRACKED)
            robot.x = robot.y = robot.theta = robot.v = math.nan
            team.robots.append(robot)
        return team

    return _publish(ears, TeamState, "/team_state", make, seconds)


def nan_goals(ears: Ears, seconds: float) -> float:
    """Somebody else says where robots go: nowhere."""
    from trench_msgs.msg import Goal, Goals

    def make():
        goals = Goals(epoch=2**63)
        goals.header.stamp = _now(ears)
        for number in range(1, 5):
            goal = Goal(robot=f"robot{number}", remaining=1e9)
            goal.position.x = goal.position.y = math.nan
            goals.goals.append(goal)
        return goals

    return _publish(ears, Goals, "/goals", make, seconds)


def garbage_udp(ears: Ears, seconds: float) -> float:
    """Noise on every DDS port of the domain that a participant may have, half of it behind an RTPS header."""
    del ears
    chance = random.Random(1)
    base = 7400 + 250 * int(os.environ["ROS_DOMAIN_ID"])
    ports = [base, base + 1, *range(base + 10, base + 60)]
    header = b"RTPS\x02\x04\x01\x12" + bytes(12)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        began, end = time.time(), time.monotonic() + seconds
        while time.monotonic() < end:
            for port in ports:
                noise = chance.randbytes(chance.randrange(1, 1400))
                sender.sendto(header + noise if chance.random() < 0.5 else noise, ("127.0.0.1", port))
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
    for function in (foreign_command, nan_team_state, nan_goals, garbage_udp, emergency_stop)
}
