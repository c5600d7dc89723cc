"""A serial line between test bed and bridge that somebody can unplug.

usage: line.py FAR NEAR TAP

What the bridge says is kept in TAP, each piece behind its time and length (wheels.py). FAR is the test bed's end, which may not be there yet; NEAR is a link to a pseudo-terminal that the bridge opens. Each line on
standard input is `out` or `in`: unplugged, the device of NEAR is gone. Ends with its standard input.
"""

import os
import pty
import select
import struct
import sys
import termios
import time
import tty
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

# In front of each piece: when it was said, s, and its length (as in wheels.py, whose modules are none of this process's concern).
PIECE = struct.Struct("<dI")
# How often a FAR that is not there is looked for, s.
RETRY = 0.05
# Of the control loop (crates/runtime/src/priority.rs) everybody has less.
PRIORITY = 20


def be_a_wire() -> None:
    """Nobody who computes holds up a wire, and what it bears is written down with the time at which it was said."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    except PermissionError:
        pass


def raw(terminal: int) -> None:
    """No character means anything."""
    tty.setraw(terminal, termios.TCSANOW)
    os.set_blocking(terminal, False)


class Near:
    """The bridge's end."""

    def __init__(self, link: str):
        self.link, self.ends = link, ()

    def plug(self) -> None:
        """There is a device."""
        master, slave = pty.openpty()
        raw(slave)
        os.set_blocking(master, False)
        new = f"{self.link}.new"
        os.symlink(os.ttyname(slave), new)
        os.rename(new, self.link)
        # Our own slave keeps the line alive while the bridge has not opened it.
        self.ends = (master, slave)

    def unplug(self) -> None:
        """The device is gone, for who has it open too."""
        os.unlink(self.link)
        for end in self.ends:
            os.close(end)
        self.ends = ()


def copy(source: int, target: int | None, tap: BinaryIO | None = None) -> bool:
    """What there is; without a target it is lost. False where the source has gone."""
    try:
        data = os.read(source, 4096)
    except OSError:
        return False
    if tap:
        tap.write(PIECE.pack(time.time(), len(data)) + data)
    try:
        if target is not None:
            os.write(target, data)
    except OSError:
        pass
    return bool(data)


def main() -> None:
    """Until standard input ends."""
    be_a_wire()
    far_link, near = sys.argv[1], Near(sys.argv[2])
    # In memory until the end: a disk that is busy with bags would hold up the line.
    tap = BytesIO()
    near.plug()
    print("ready", flush=True)
    far = None
    while True:
        if far is None and os.path.exists(far_link):
            far = os.open(far_link, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
            raw(far)
        sources = [0, *([far] if far is not None else []), *near.ends[:1]]
        ready, _, _ = select.select(sources, [], [], RETRY if far is None else None)
        if far in ready and not copy(far, near.ends[0] if near.ends else None):
            os.close(far)
            far = None
            time.sleep(RETRY)
        if near.ends and near.ends[0] in ready:
            copy(near.ends[0], far, tap)
        if 0 in ready:
            said = os.read(0, 64)
            if not said:
                break
            if said.strip() == b"out":
                near.unplug()
            else:
                near.plug()
            print("done", flush=True)
    Path(sys.argv[3]).write_bytes(tap.getvalue())
    if near.ends:
        near.unplug()


if __name__ == "__main__":
    main()
