"""Subscribes a topic and prints the messages it gets, like `ros2 topic echo`: so many at once with their rate, or one a
line for as long as it lives.
"""

import time

import peer


def main() -> None:
    arguments = peer.parser(__doc__)
    arguments.add_argument("topic")
    arguments.add_argument("type", help="for example nav_msgs/msg/Odometry")
    arguments.add_argument("--qos", type=peer.qos, default="best_effort,volatile,10", help="reliability,durability,depth")
    arguments.add_argument("--count", type=int, default=1, help="how many messages to wait for")
    arguments.add_argument("--settle", type=float, default=0.0, help="s to go on listening; the last messages count")
    arguments.add_argument("--follow", action="store_true", help="print each message as it comes, until SIGINT or SIGTERM")
    given = arguments.parse_args()
    messages, times = [], []

    def receive(message) -> None:
        if given.follow:
            peer.report(peer.plain(message))
            return
        times.append(time.monotonic())
        messages.append(peer.plain(message))

    with peer.node("peer_echo") as node:
        node.create_subscription(peer.message_type(given.type), given.topic, receive, given.qos)
        if given.follow:
            peer.spin_until(node, lambda: False, float("inf"))
            return
        if not peer.spin_until(node, lambda: len(messages) >= given.count, given.timeout):
            peer.fail(f"{len(messages)} of {given.count} messages on {given.topic} within {given.timeout} s")
        peer.spin_until(node, lambda: False, given.settle)
        messages = messages[-given.count :]
        rate = (len(times) - 1) / (times[-1] - times[0]) if times[-1] > times[0] else None
        peer.report({"topic": given.topic, "type": given.type, "rate": rate, "messages": messages})


if __name__ == "__main__":
    main()
