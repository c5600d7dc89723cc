"""Writes a bag with rosbags (PyPI): COUNT std_msgs/msg/Bool that say true on /emergency_stop, 20 ms apart.

usage: bag_write_stop.py BAG COUNT
"""

import sys
from pathlib import Path

from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore


def main() -> None:
    store = get_typestore(Stores.LATEST)
    bool_type = store.types["std_msgs/msg/Bool"]
    with Writer(Path(sys.argv[1]), version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/emergency_stop", bool_type.__msgtype__, typestore=store)
        for index in range(int(sys.argv[2])):
            cdr = store.serialize_cdr(bool_type(True), bool_type.__msgtype__)
            writer.write(connection, 1_000_000_000 + index * 20_000_000, cdr)


if __name__ == "__main__":
    main()
