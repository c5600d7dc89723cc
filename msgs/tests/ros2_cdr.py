"""Prints the CDR that ROS 2 itself makes of filled standard messages, as JSON: the content of ros2_cdr.json.

    eval "$(scripts/ros-venv --env)"
    cargo run -p trench_msgs --example type_hashes | python3 msgs/tests/ros2_cdr.py > msgs/tests/ros2_cdr.json

ROS 2 leaves whatever was in memory in padding bytes, so two runs differ there. The rule of the values is in ros2_cdr.rs: leaf k (from 1, in the order of
the definition) holds the number k, the text "sk" or the truth of "k is odd"; every sequence has two elements, or as many
as its bound allows. Arrays and sequences of bytes are one leaf, all bytes k.
"""

import importlib
import json
import sys

from rclpy.serialization import serialize_message
from rosidl_parser.definition import AbstractSequence, AbstractString, Array, BasicType, BoundedSequence, NamespacedType


class Filler:
    def __init__(self):
        self.count = 0

    def leaf(self, kind):
        self.count += 1
        if isinstance(kind, AbstractString):
            return f"s{self.count}"
        if kind.typename == "boolean":
            return self.count % 2 == 1
        if kind.typename in ("float", "double"):
            return float(self.count)
        if kind.typename == "octet":
            return bytes([self.count])
        return self.count

    def value(self, kind):
        if isinstance(kind, NamespacedType):
            module = importlib.import_module(".".join(kind.namespaces))
            return self.message(getattr(module, kind.name))
        if isinstance(kind, (Array, AbstractSequence)):
            length = kind.size if isinstance(kind, Array) else 2
            if isinstance(kind, BoundedSequence):
                length = min(length, kind.maximum_size)
            element = kind.value_type
            if isinstance(element, BasicType) and element.typename in ("uint8", "octet"):
                return [self.leaf(element)] * length
            return [self.value(element) for _ in range(length)]
        return self.leaf(kind)

    def message(self, cls):
        message = cls()
        names = [name for name in cls.get_fields_and_field_types() if name != "structure_needs_at_least_one_member"]
        for name, kind in zip(names, cls.SLOT_TYPES):
            setattr(message, name, self.value(kind))
        return message


vectors = {}
for name in json.load(sys.stdin):
    package, namespace, short = name.split("/")
    if package == "trench_msgs":  # still changes; the interop tests exchange it with a live rclpy
        continue
    try:
        cls = getattr(importlib.import_module(f"{package}.{namespace}"), short)
    except ModuleNotFoundError:
        continue
    if not hasattr(cls, "SLOT_TYPES"):  # a service, whose halves are messages of their own
        continue
    vectors[name] = bytes(serialize_message(Filler().message(cls))).hex()
print(json.dumps(vectors, indent=1))
