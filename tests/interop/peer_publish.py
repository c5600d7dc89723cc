"""Publishes messages that it reads from standard input, one JSON document a line, until the input ends: fields that are
left out have their default, and NaN is a number. Each line is answered with the time (ns) before it was published.
"""

import json
import queue
import sys
import threading

import peer


def read_lines(lines: queue.SimpleQueue) -> None:
    """Passes on what comes on standard input; None at its end."""
    for line in sys.stdin:
        lines.put(line)
    lines.put(None)


def main() -> None:
    arguments = peer.parser(__doc__)
    arguments.add_argument("topic", nargs="?", default="/emergency_stop")
    arguments.add_argument("type", nargs="?", default="std_msgs/msg/Bool", help="for example nav_msgs/msg/Odometry")
    arguments.add_argument("--qos", type=peer.qos, default="reliable,volatile,10", help="reliability,durability,depth")
    arguments.add_argument("--rate", type=float, help="repeat the last line so many times a second")
    arguments.add_argument("--stamp", action="store_true", help="set header.stamp to the time of publication")
    arguments.add_argument("--subscribers", type=int, default=1, help="wait for so many first (default: 1)")
    given = arguments.parse_args()
    lines = queue.SimpleQueue()
    threading.Thread(target=read_lines, args=[lines], daemon=True).start()
    with peer.node("peer_publish") as node:
        publisher = node.create_publisher(peer.message_type(given.type), given.topic, given.qos)

        def publish(message) -> int:
            now = node.get_clock().now()
            if given.stamp:
                message.header.stamp = now.to_msg()
            publisher.publish(message)
            return now.nanoseconds

        if not peer.spin_until(node, lambda: publisher.get_subscription_count() >= given.subscribers, given.timeout):
            peer.fail(f"{publisher.get_subscription_count()} subscribers of {given.topic} within {given.timeout} s")
        message = None
        while True:
            try:
                line = lines.get(timeout=1 / given.rate if given.rate and message else None)
            except queue.Empty:
                publish(message)
                continue
            if line is None:
                break
            message = peer.fill(peer.message_type(given.type)(), json.loads(line))
            peer.report({"published": publish(message)})
        # A reliable writer that is gone repeats nothing: wait until all have it.
        publisher.wait_for_all_acked()


if __name__ == "__main__":
    main()
