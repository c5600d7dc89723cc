"""What a foreign implementation of rmw_zenoh's protocol (zenoh-ros2-sdk) sees, hears and is answered.

Prints JSON as the rclpy peers do. ZENOH_CONFIG_OVERRIDE says where the router is, ROS_DOMAIN_ID the domain.

usage:
  peer_zenoh.py graph
  peer_zenoh.py echo TOPIC TYPE HASH [--latched]       message definitions are read from msgs/
  peer_zenoh.py publish TOPIC TYPE HASH JSON           ten times a second, for as long as it lives
  peer_zenoh.py trigger SERVICE HASH
"""

import argparse
import dataclasses
import json
import math
import pathlib
import re
import sys
import threading
import time

import zenoh_ros2_sdk as sdk
from zenoh_ros2_sdk.qos import QosDurability, QosProfile
from zenoh_ros2_sdk.utils import resolve_domain_id

MESSAGES = pathlib.Path(__file__).parents[2] / "msgs"


def definition(name: str) -> str:
    """The .msg file of a type."""
    package, _, message = name.split("/")
    folder = MESSAGES if package == "trench_msgs" else MESSAGES / "standard" / package
    return (folder / "msg" / f"{message}.msg").read_text()


def register(name: str) -> str:
    """Makes a type and all that it holds known to the peer; gives its definition."""
    text = definition(name)
    for line in text.splitlines():
        field = line.split("#")[0].split()
        if not field or "=" in line.split("#")[0]:
            continue
        inner = re.sub(r"\[.*", "", field[0])
        if "/" in inner:
            package, message = inner.split("/")
        elif inner == "Header":
            package, message = "std_msgs", "Header"
        elif inner[0].isupper():
            package, message = name.split("/")[0], inner
        else:
            continue
        register(f"{package}/msg/{message}")
    sdk.ZenohSession.get_instance().register_message_type(text, name)
    return text


def plain(value):
    """A message as JSON has it."""
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value) if not field.name.startswith("_")]
        return {name: plain(getattr(value, name)) for name in names}
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def report(document) -> None:
    print(json.dumps(document), flush=True)


def graph() -> None:
    """All nodes, topics and services, once there are any."""
    session = sdk.ZenohSession.get_instance()
    topics = {}
    while not topics:
        topics = {name: types for name, types in sdk.get_topic_names_and_types(timeout=2.0)}
    pattern = f"@ros2_lv/{resolve_domain_id(None)}/*/*/*/NN/**"
    nodes = sorted(
        str(reply.ok.key_expr).split("/")[7].replace("%", "/").rstrip("/") + "/" + str(reply.ok.key_expr).split("/")[8]
        for reply in session.liveliness.get(pattern, timeout=2.0)
        if reply.ok is not None
    )
    services = {name: types for name, types in sdk.get_service_names_and_types(timeout=2.0)}
    report({"nodes": nodes, "topics": topics, "services": services})


def echo(topic: str, name: str, type_hash: str, latched: bool) -> None:
    """Messages, one a line."""
    text = register(name)
    durability = QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE
    heard = threading.Event()

    def hear(message) -> None:
        report(plain(message))
        heard.set()

    while True:
        subscriber = sdk.ROS2Subscriber(
            topic,
            name,
            callback=hear,
            msg_definition=text,
            type_hash=type_hash,
            qos=QosProfile(durability=durability, history_depth=1),
        )
        # The SDK asks for the past once, of those whom its session knows right after it has been opened: often of nobody.
        if not latched or heard.wait(2.0):
            break
        subscriber.close()
    while True:
        time.sleep(1.0)


def publish(topic: str, name: str, type_hash: str, document: str) -> None:
    publisher = sdk.ROS2Publisher(topic, name, msg_definition=register(name), type_hash=type_hash)
    while True:
        publisher.publish(**json.loads(document))
        time.sleep(0.1)


def trigger(service: str, type_hash: str) -> None:
    client = sdk.ROS2ServiceClient(
        service,
        "std_srvs/srv/Trigger",
        request_definition="",
        response_definition="bool success\nstring message",
        type_hash=type_hash,
    )
    answer = client.call()
    if answer is None:
        sys.exit(f"{service} does not answer")
    report({"success": bool(answer.success), "message": answer.message})


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=["graph", "echo", "publish", "trigger"])
    parser.add_argument("arguments", nargs="*")
    parser.add_argument("--latched", action="store_true")
    parser.add_argument("--timeout", type=float)
    options = parser.parse_args()
    if options.what == "echo":
        echo(*options.arguments, options.latched)
    else:
        {"graph": graph, "publish": publish, "trigger": trigger}[options.what](*options.arguments)
