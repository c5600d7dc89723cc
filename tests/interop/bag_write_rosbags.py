"""Writes a bag with rosbags (PyPI): COUNT messages 10 ms apart from t = 1 s on, either std_msgs/msg/Float64 0, 1, 2 ... on
/value or std_msgs/msg/Bool, all true, on /emergency_stop.

usage: bag_write_rosbags.py BAG COUNT [/value | /emergency_stop]
"""

import sys
from pathlib import Path

from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

TOPICS = {"/value": ("std_msgs/msg/Float64", float), "/emergency_stop": ("std_msgs/msg/Bool", lambda _: True)}


def main() -> None:
    store = get_typestore(Stores.LATEST)
    topic = sys.argv[3] if len(sys.argv) > 3 else "/value"
    name, value = TOPICS[topic]
    message = store.types[name]
    with Writer(Path(sys.argv[1]), version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection(topic, name, typestore=store)
        for index in range(int(sys.argv[2])):
            cdr = store.serialize_cdr(message(value(index)), name)
            writer.write(connection, 1_000_000_000 + index * 10_000_000, cdr)


if __name__ == "__main__":
    main()
