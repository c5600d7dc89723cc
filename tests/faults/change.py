"""Asks for other formations, on whichever host it runs: one request a line of standard input, one answer a line of standard output.

A request is a JSON object of what ~/set_formation takes, `scale` or `robots`; the answer whether it was granted, true or false.
"""

import json
import sys
import time

import rclpy
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


def main() -> None:
    """Until standard input ends."""
    rclpy.init()
    node = rclpy.create_node("somebody", enable_rosout=False, start_parameter_services=False)
    client = node.create_client(SetFormation, "/leader_assignment/set_formation")
    client.wait_for_service(timeout_sec=PATIENCE)
    print("ready", flush=True)
    for line in sys.stdin:
        print(json.dumps(ask(node, client, json.loads(line))), flush=True)
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
