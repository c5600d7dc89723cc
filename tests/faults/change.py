"""Asks for other formations, on whichever host it runs: one request a line of standard input, one answer a line of standard output.

A request is a JSON object of what ~/set_formation takes, `name`, `scale` or `robots`, or a `shape`: a file beside this one of a formation whose queues lie on lines, which is sent on
/set_formation as anybody may, and whose goals rest at its vertices. The answer is whether it was granted, true or false.
"""

import json
import sys
import time
from pathlib import Path

import rclpy
import yaml
from rclpy.qos import DurabilityPolicy, QoSProfile
from trench_msgs.msg import Formation, Point2, Queue, Segment
from trench_msgs.srv import SetFormation

# s, for which a request is repeated: whoever would grant it may be dead, or see too few robots; and for which one answer is waited for.
PATIENCE, ANSWER = 8.0, 0.8
# s, between two requests.
AGAIN = 0.2


def ask(node, client, request: dict) -> bool:
    """Until it is granted, or patience is at its end."""
    began = time.monotonic()
    while time.monotonic() < began + PATIENCE:
        if client.wait_for_service(timeout_sec=ANSWER):
            answer = client.call_async(SetFormation.Request(**request))
            rclpy.spin_until_future_complete(node, answer, timeout_sec=ANSWER)
            if answer.done() and answer.result().success:
                return True
            client.remove_pending_request(answer)
            print(f"{request}: {answer.result().message if answer.done() else 'no answer'}", file=sys.stderr, flush=True)
        time.sleep(AGAIN)
    return False


def shape(file: str) -> Formation:
    """A formation from a file whose segments are lines."""
    told = yaml.safe_load(Path(__file__).with_name(file).read_text(encoding="utf-8"))
    formation = Formation(name=told["name"])
    formation.header.frame_id = told["frame"]
    for queue in told["queues"]:
        line = Segment(kind=Segment.KIND_LINE, points=[Point2(x=x, y=y) for x, y in queue["segment"]["points"]])
        vertices = [Point2(x=x, y=y) for x, y in queue["vertices"]]
        formation.queues.append(Queue(name=queue["name"], segment=line, vertices=vertices, share=queue["share"], tolerance=queue["tolerance"]))
    return formation


def put(node, publisher, in_force: list[str], file: str) -> bool:
    """Says a formation until it is in force."""
    formation, began = shape(file), time.monotonic()
    while time.monotonic() < began + PATIENCE:
        if in_force and in_force[-1] == formation.name:
            return True
        publisher.publish(formation)
        said = time.monotonic()
        while time.monotonic() < said + AGAIN:
            rclpy.spin_once(node, timeout_sec=0.05)
    print(f"{file}: in force were {in_force}", file=sys.stderr, flush=True)
    return False


def main() -> None:
    """Until standard input ends."""
    rclpy.init()
    node = rclpy.create_node("somebody", enable_rosout=False, start_parameter_services=False)
    client = node.create_client(SetFormation, "/leader_assignment/set_formation")
    publisher, in_force = node.create_publisher(Formation, "/set_formation", 10), []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(Formation, "/formation", lambda formation: in_force.append(formation.name), latched)
    client.wait_for_service(timeout_sec=PATIENCE)
    print("ready", flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        granted = put(node, publisher, in_force, request["shape"]) if "shape" in request else ask(node, client, request)
        print(json.dumps(granted), flush=True)
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
