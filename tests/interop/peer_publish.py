"""Publishes a std_msgs/msg/Bool, as an operator does on /emergency_stop, at a steady rate."""

from std_msgs.msg import Bool

import peer


def main() -> None:
    arguments = peer.parser(__doc__)
    arguments.add_argument("topic", nargs="?", default="/emergency_stop")
    arguments.add_argument("value", nargs="?", choices=["true", "false"], default="true")
    arguments.add_argument("--qos", type=peer.qos, default="reliable,volatile,1", help="reliability,durability,depth")
    arguments.add_argument("--count", type=int, default=1, help="how often (default: once)")
    arguments.add_argument("--rate", type=float, default=10.0, help="times a second (default: 10)")
    arguments.add_argument("--subscribers", type=int, default=1, help="wait for so many first (default: 1)")
    given = arguments.parse_args()
    with peer.node("peer_publish") as node:
        publisher = node.create_publisher(Bool, given.topic, given.qos)
        if not peer.spin_until(node, lambda: publisher.get_subscription_count() >= given.subscribers, given.timeout):
            peer.fail(f"{publisher.get_subscription_count()} subscribers of {given.topic} within {given.timeout} s")
        for _ in range(given.count):
            publisher.publish(Bool(data=given.value == "true"))
            peer.spin_until(node, lambda: False, 1 / given.rate)
        # A reliable writer that is gone repeats nothing: wait until all have it.
        publisher.wait_for_all_acked()
        peer.report({"topic": given.topic, "published": given.count, "subscribers": publisher.get_subscription_count()})


if __name__ == "__main__":
    main()
