"""Writes a bag with rosbags (PyPI): COUNT std_msgs/msg/Float64 on /value, 10 ms apart from t = 1 s, values 0, 1, 2 ...

usage: bag_write_rosbags.py BAG COUNT
"""

import sys
from pathlib import Path

from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore


def main() -> None:
    store = get_typestore(Stores.LATEST)
    float64 = store.types["std_msgs/msg/Float64"]
    with Writer(Path(sys.argv[1]), version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/value", float64.__msgtype__, typestore=store)
        for index in range(int(sys.argv[2])):
            cdr = store.serialize_cdr(float64(float(index)), float64.__msgtype__)
            writer.write(connection, 1_000_000_000 + index * 10_000_000, cdr)


if __name__ == "__main__":
    main()
