"""What the peers share: a node, a time limit, types by name, messages as JSON.

Every peer prints JSON, one document a line, on standard output and ends with 0, or says on standard error why it could
not and ends with 1. ROS_DOMAIN_ID and the variables of `scripts/ros-venv --env` must be set.
"""

import argparse
import importlib
import json
import math
import re
import sys
import time
from collections.abc import Callable
from contextlib import contextmanager

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy


def parser(description: str) -> argparse.ArgumentParser:
    """A parser with the option that all peers have."""
    result = argparse.ArgumentParser(description=description)
    result.add_argument("--timeout", type=float, default=10.0, help="seconds (default: 10)")
    return result


@contextmanager
def node(name: str):
    """A node for the time of a `with` block, which SIGINT and SIGTERM end quietly."""
    rclpy.init()
    try:
        created = Node(name, enable_rosout=False, start_parameter_services=False)
        try:
            yield created
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        finally:
            created.destroy_node()
    finally:
        rclpy.try_shutdown()


def spin_until(spun: Node, done: Callable[[], bool], timeout: float) -> bool:
    """Lets the node work until `done()` or until `timeout` seconds have passed. Whether it was done."""
    deadline = time.monotonic() + timeout
    while not done() and time.monotonic() < deadline:
        rclpy.spin_once(spun, timeout_sec=0.05)
    return done()


def qos(text: str) -> QoSProfile:
    """A profile from, for example, `reliable,transient_local,1` (reliability, durability, depth)."""
    reliability, durability, depth = text.split(",")
    return QoSProfile(
        reliability=QoSReliabilityPolicy[reliability.upper()],
        durability=QoSDurabilityPolicy[durability.upper()],
        depth=int(depth),
    )


def message_type(name: str):
    """The class of a type such as `nav_msgs/msg/Odometry`."""
    package, kind, message = name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), message)


def plain(value):
    """A message as JSON has it."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if hasattr(value, "tolist"):  # numpy's arrays and numbers, array.array
        return plain(value.tolist())
    if isinstance(value, (list, tuple, set, bytes)):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)  # JSON has no word for it
    return value


def fill(message, document: dict):
    """Sets the fields of a message to the values of a JSON document; what the document leaves out stays as it is."""
    types = message.get_fields_and_field_types()
    for name, value in document.items():
        if isinstance(value, dict):
            fill(getattr(message, name), value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            package, element = re.split(r"[<>\[\]]", types[name].removeprefix("sequence<"))[0].split("/")
            setattr(message, name, [fill(message_type(f"{package}/msg/{element}")(), one) for one in value])
        else:
            setattr(message, name, value)
    return message


def report(document) -> None:
    """Prints the result."""
    print(json.dumps(document), flush=True)


def fail(problem: str) -> None:
    """Ends the program with 1."""
    print(f"{sys.argv[0]}: {problem}", file=sys.stderr)
    sys.exit(1)
