"""Reads a bag with rosbags (PyPI) and prints one JSON line a message: what another implementation makes of our bags.

usage: bag_rosbags.py BAG
"""

import json
import sys
from pathlib import Path

from rosbags.highlevel import AnyReader


def main() -> None:
    with AnyReader([Path(sys.argv[1])]) as reader:
        for connection, log_time, cdr in reader.messages():
            reader.deserialize(cdr, connection.msgtype)  # fails where schema and bytes disagree
            print(json.dumps({
                "topic": connection.topic,
                "type": connection.msgtype,
                "hash": connection.digest,
                "log_time": log_time,
                "cdr": bytes(cdr).hex(),
            }))


if __name__ == "__main__":
    main()
