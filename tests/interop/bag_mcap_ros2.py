"""Reads an .mcap file with mcap-ros2-support (PyPI), checksums validated, and prints one JSON line a message.

usage: bag_mcap_ros2.py FILE.mcap
"""

import json
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory


def plain(value):
    """A decoded message as JSON has it."""
    if hasattr(value, "__slots__"):
        return {name: plain(getattr(value, name)) for name in value.__slots__}
    return [plain(item) for item in value] if isinstance(value, (list, tuple)) else value


def main() -> None:
    with open(sys.argv[1], "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        assert reader.get_header().profile == "ros2"
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            print(json.dumps({
                "topic": channel.topic,
                "type": schema.name,
                "log_time": message.log_time,
                "publish_time": message.publish_time,
                "sequence": message.sequence,
                "cdr": message.data.hex(),
                "message": plain(decoded),
            }))


if __name__ == "__main__":
    main()
