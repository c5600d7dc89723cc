"""The same measurement as crates/runtime/examples/latency, by Python peers: the way of messages of a given length from one
process to another on this host.

usage: transport.py {rclpy,cyclonedds} {source,probe} --bytes N --rate R --count N

The probe prints percentiles of the time from before the message is made to the subscriber's callback, and how many came a second. Both
stamp with CLOCK_MONOTONIC, which all processes of a host share.
"""

import argparse
import array
import struct
import sys
import time


def report(came: list[tuple[int, int]]) -> None:
    """Of pairs of when a message came and how long it took, ns."""
    rate = (len(came) - 1) * 1e9 / (came[-1][0] - came[0][0])
    nanoseconds = sorted(took for _, took in came)
    micro = [nanoseconds[int((len(nanoseconds) - 1) * share)] / 1000 for share in (0.5, 0.99, 1.0)]
    print("p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us, {:.0f} a second".format(*micro, rate), flush=True)


def pace(rate: float):
    """Gives once a period, for ever."""
    due = time.monotonic()
    while True:
        due += 1.0 / rate
        time.sleep(max(0.0, due - time.monotonic()))
        yield


def with_rclpy(options) -> None:
    import rclpy
    from rclpy.qos import QoSProfile
    from std_msgs.msg import UInt8MultiArray

    rclpy.init()
    node = rclpy.create_node(f"latency_{options.role}")
    if options.role == "source":
        publisher = node.create_publisher(UInt8MultiArray, "/stamps", QoSProfile(depth=16))
        body = bytes(options.bytes - 8)
        for _ in pace(options.rate):
            stamp = time.monotonic_ns()
            message = UInt8MultiArray()
            message.data = array.array("B", struct.pack("<Q", stamp) + body)
            publisher.publish(message)
    taken: list[tuple[int, int]] = []

    def hear(message) -> None:
        now = time.monotonic_ns()
        taken.append((now, now - struct.unpack("<Q", message.data[:8].tobytes())[0]))

    node.create_subscription(UInt8MultiArray, "/stamps", hear, QoSProfile(depth=16))
    while len(taken) < options.count:
        rclpy.spin_once(node)
    report(taken)


def with_cyclonedds(options) -> None:
    from dataclasses import dataclass

    from cyclonedds.core import Listener
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.idl import IdlStruct
    from cyclonedds.idl.types import sequence, uint8
    from cyclonedds.pub import DataWriter
    from cyclonedds.qos import Policy, Qos
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic
    from cyclonedds.util import duration

    @dataclass
    class Stamps(IdlStruct, typename="Stamps"):
        data: sequence[uint8]

    participant = DomainParticipant(options.domain)
    qos = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(16))
    topic = Topic(participant, "stamps", Stamps, qos=qos)
    if options.role == "source":
        writer = DataWriter(participant, topic, qos=qos)
        body = bytes(options.bytes - 8)
        for _ in pace(options.rate):
            writer.write(Stamps(data=struct.pack("<Q", time.monotonic_ns()) + body))
    taken: list[tuple[int, int]] = []

    class Hear(Listener):
        def on_data_available(self, reader) -> None:
            for sample in reader.take(16):
                now = time.monotonic_ns()
                taken.append((now, now - struct.unpack("<Q", bytes(sample.data[:8]))[0]))

    _reader = DataReader(participant, topic, qos=qos, listener=Hear())
    while len(taken) < options.count:
        time.sleep(0.05)
    report(taken[: options.count])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("peer", choices=["rclpy", "cyclonedds"])
    parser.add_argument("role", choices=["source", "probe"])
    parser.add_argument("--bytes", type=int, default=64)
    parser.add_argument("--rate", type=float, default=200.0)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--domain", type=int, default=93)
    options = parser.parse_args()
    try:
        {"rclpy": with_rclpy, "cyclonedds": with_cyclonedds}[options.peer](options)
    except KeyboardInterrupt:
        sys.exit(130)
