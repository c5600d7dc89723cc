"""Subscribes sensor_msgs/Image as a viewer does, and says of each picture its size and the CRC-32 of its pixels: whether it came whole."""

import time
import zlib

import peer
from sensor_msgs.msg import Image


def main() -> None:
    arguments = peer.parser(__doc__)
    arguments.add_argument("topic")
    arguments.add_argument("--qos", type=peer.qos, default="best_effort,volatile,5", help="reliability,durability,depth")
    arguments.add_argument("--count", type=int, default=30, help="how many pictures to wait for")
    given = arguments.parse_args()
    pictures, times = [], []

    def receive(image: Image) -> None:
        times.append(time.monotonic())
        sides = [image.width, image.height, image.step]
        pictures.append({"encoding": image.encoding, "sides": sides, "crc32": zlib.crc32(image.data)})

    with peer.node("peer_viewer") as node:
        node.create_subscription(Image, given.topic, receive, given.qos)
        if not peer.spin_until(node, lambda: len(pictures) >= given.count, given.timeout):
            peer.fail(f"{len(pictures)} of {given.count} pictures on {given.topic} within {given.timeout} s")
        rate = (len(times) - 1) / (times[-1] - times[0]) if times[-1] > times[0] else None
        peer.report({"rate": rate, "pictures": pictures})


if __name__ == "__main__":
    main()
