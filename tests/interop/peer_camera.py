"""An ordinary camera driver: publishes sensor_msgs/Image at a rate, each frame with other pixels, and says how many it sent.

The pictures are grey with noise: no pads are in them; or sensor_msgs/CompressedImage, of the bytes of one file. It waits for a
subscriber first, and a second longer for what else has to be found.
"""

import random
import time
from pathlib import Path

import peer
from sensor_msgs.msg import CompressedImage, Image

WIDTH, HEIGHT = 768, 576
PICTURES = 8


def images() -> list[Image]:
    chance = random.Random(1)
    messages = []
    for _ in range(PICTURES):
        message = Image(width=WIDTH, height=HEIGHT, encoding="rgb8", step=3 * WIDTH)
        message.data.frombytes(bytes(chance.choices(range(120, 130), k=3 * WIDTH)) * HEIGHT)
        messages.append(message)
    return messages


def main() -> None:
    arguments = peer.parser(__doc__)
    arguments.add_argument("--topic", default="/overhead/image_raw")
    arguments.add_argument("--qos", type=peer.qos, default="best_effort,volatile,5", help="reliability,durability,depth")
    arguments.add_argument("--rate", type=float, default=30.0)
    arguments.add_argument("--frames", type=int, default=600)
    arguments.add_argument("--jpeg", type=Path, help="a picture to publish as CompressedImage instead")
    given = arguments.parse_args()
    messages = images()
    if given.jpeg:
        messages = [CompressedImage(format="jpeg", data=given.jpeg.read_bytes())]
    for message in messages:
        message.header.frame_id = "overhead_camera"
    with peer.node("peer_camera") as node:
        publisher = node.create_publisher(type(messages[0]), given.topic, given.qos)
        if not peer.spin_until(node, lambda: publisher.get_subscription_count() > 0, given.timeout):
            peer.fail(f"no subscriber of {given.topic} within {given.timeout} s")
        time.sleep(1.0)
        start = time.monotonic()
        late = 0.0
        for index in range(given.frames):
            due = start + index / given.rate
            time.sleep(max(0.0, due - time.monotonic()))
            message = messages[index % len(messages)]
            message.header.stamp = node.get_clock().now().to_msg()
            publisher.publish(message)
            late = max(late, time.monotonic() - due)
        # What is still under way.
        time.sleep(1.0)
        peer.report({"sent": given.frames, "seconds": time.monotonic() - start - 1.0, "latest": late})


if __name__ == "__main__":
    main()
