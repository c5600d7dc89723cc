"""What the bridge says to the wheels, from a tap of the serial line (line.py, docs/protocols/radio.md), and on whose word."""

import binascii
import math
import struct
from dataclasses import dataclass
from pathlib import Path

from bag import Run, Series
from motion import AGE, HALF_AXLE

# m/s times timer value, the slowest speed of a wheel that turns, and the fastest.
SPEED_TIMES_TIMER, SLOWEST, FASTEST = 1060.288, 0.0162, 0.3
# m/s, to which a wheel speed is what a command says: a step of the timer at full speed is 0.09 mm/s.
CLOSE = 0.0005
# In front of each piece of the tap: when it was written, s, and its length.
PIECE = struct.Struct("<dI")
# Bits of a packet's flags that say how often it may be relayed: then a list of relays follows.
RELAYED = 0b1110
DOWNLINK, COMMANDS = 0x30, 0x30


@dataclass
class Order:
    """What a packet of commands says to one robot."""

    at: float
    robot: int
    left: float
    right: float


def unstuff(frame: bytes) -> bytes | None:
    """COBS undone."""
    result, place = bytearray(), 0
    while place < len(frame):
        code = frame[place]
        if code == 0 or place + code > len(frame):
            return None
        result += frame[place + 1 : place + code]
        place += code
        if code < 0xFF and place < len(frame):
            result.append(0)
    return bytes(result)


def orders_of(at: float, frame: bytes) -> list[Order]:
    """What a frame on the line says to wheels."""
    body = unstuff(frame)
    if not body or len(body) < 18 or body[0] != DOWNLINK or body[1] != COMMANDS:
        return []
    if binascii.crc_hqx(body[:-2], 0xFFFF) != int.from_bytes(body[-2:], "little"):
        return []
    payload = body[9 + (2 if body[2] & RELAYED else 0) : -2]
    robots = [robot for robot in range(32) if int.from_bytes(payload[1:5], "little") >> robot & 1]
    timers = struct.unpack_from(f"<{2 * len(robots)}H", payload, 5)
    places = payload[5 + 4 * len(robots) :]
    back = int.from_bytes(places[: (2 * len(robots) + 7) // 8], "little")
    speeds = [0.0 if timer == 0 else SPEED_TIMES_TIMER / timer for timer in timers]
    signed = [-speed if back >> bit & 1 else speed for bit, speed in enumerate(speeds)]
    return [Order(at, robot, *signed[2 * index : 2 * index + 2]) for index, robot in enumerate(robots)]


def orders(tap: Path) -> list[Order]:
    """All that wheels were told."""
    data, place, left, found = tap.read_bytes(), 0, b"", []
    while place + PIECE.size <= len(data):
        at, length = PIECE.unpack_from(data, place)
        *frames, left = (left + data[place + PIECE.size : place + PIECE.size + length]).split(b"\0")
        place += PIECE.size + length
        for frame in frames:
            found += orders_of(at, frame)
    return found


def says(command: tuple[float, float], order: Order) -> bool:
    """Whether these wheel speeds are what a command says: beyond the fastest on the same curve, below the slowest in turns."""
    wanted = [command[0] - HALF_AXLE * command[1], command[0] + HALF_AXLE * command[1]]
    scale = min(1.0, FASTEST / max(map(abs, wanted), default=1.0)) if any(wanted) else 1.0
    for speed, told in zip((scale * speed for speed in wanted), (order.left, order.right)):
        dithered = abs(speed) < SLOWEST + CLOSE and (told == 0.0 or (speed * told > 0.0 and abs(told) <= 2.0 * SLOWEST + CLOSE))
        if not dithered and abs(speed - told) > CLOSE:
            return False
    return True


def founded(bag: Run, everywhere: list[Run], tap: Path) -> tuple[list[str], dict[str, Series]]:
    """Wheels that were told to turn on no command of the robot's own controller that is young enough; and of each robot, over time, the stamp
    of the newest command that what its wheels were told rests on, s.

    Whether and when a command was heard by who records says nothing: a link of its own may lose it, or bring it later than the bridge's. So
    there are records of several places.
    """
    said = by_stamp(everywhere)
    problems, basis, told = [], {robot: Series() for robot in said}, 0
    for order in orders(tap):
        robot = f"robot{order.robot}"
        if (order.left, order.right) == (0.0, 0.0) or not (bag.t0 or math.inf) <= order.at <= (bag.stopped or math.inf):
            continue
        told += 1
        young = said.get(robot, Series()).between(order.at - AGE, order.at)
        newest = max((stamp for stamp, command in young if says(command, order)), default=None)
        if newest is not None:
            basis[robot].add(order.at, newest)
        if max(abs(order.left), abs(order.right)) > FASTEST + CLOSE:
            problems.append(f"wheels of {robot} were told {order.left:.3f} and {order.right:.3f} m/s")
        elif newest is None:
            problems.append(
                f"wheels of {robot} were told {order.left:.4f} and {order.right:.4f} m/s at {order.at - bag.t0:.3f} s, which no command says that rests "
                f"on less than {AGE} s"
            )
    return problems[:3] if told else ["nothing was said to wheels"], basis


def by_stamp(everywhere: list[Run]) -> dict[str, Series]:
    """Each robot's commands over their own time, which is that of the information they rest on."""
    said = {robot: Series() for bag in everywhere for robot in bag.stamps}
    for robot, series in said.items():
        pairs = {pair for bag in everywhere if robot in bag.stamps for pair in zip(bag.stamps[robot].values, bag.commands[robot].values)}
        for stamp, command in sorted(pairs):
            series.add(stamp, command)
    return said
