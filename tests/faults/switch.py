"""A network between hosts (network namespaces) that can be bad: one process is the switch, every host has one link to it.

usage: switch.py SEED NAMESPACE:INTERFACE:ADDRESS/LENGTH ...

Makes the interface in each namespace, says "ready", and then carries frames until its standard input ends. Each line there is
JSON: the namespaces whose links change and how they are from then on, both ways or one, or pairs of them:

    {"links": ["a"], "cut": "both"}                                      "to" the host, "from" it, or "both"
    {"links": ["a", "b"], "loss": 0.3}                                   share of frames lost, each way
    {"links": ["a"], "delay": 0.1, "jitter": 0.05, "duplicate": 0.1}     s; with jitter frames overtake each other
    {"links": ["a"], "rate": 256000}                                     bit/s; what is marked as urgent goes first, what is marked
                                                                         as less (DSCP CS1) last, as Wi-Fi has it
    {"links": ["a"]}                                                     well again
    {"parted": [["a", "b"], ["a", "c"]]}                                 nothing goes between these two, either way; all others stay joined
    {"parted": []}                                                       well again

The kernel here may lack netem; a TAP interface and a loop do all of it and repeat by their seed.
"""

import ctypes
import fcntl
import heapq
import json
import os
import random
import select
import struct
import subprocess
import sys
import time
from collections import deque

TUNSETIFF, IFF_TAP, IFF_NO_PI = 0x400454CA, 0x0002, 0x1000
CLONE_NEWNET = 0x40000000
# bytes that wait for a slow link, in each of its queues: a fifth of a second at 256 kbit/s.
QUEUE = 6400
# The first three bits of DSCP from which a frame is urgent (CS4, interactive control, and above), and of what may wait (CS1).
URGENT, LESS = 4, 1


def tap(namespace: str, interface: str) -> int:
    """Opens a new TAP interface in a namespace; this process stays where it is."""
    libc = ctypes.CDLL(None, use_errno=True)
    here = os.open("/proc/self/ns/net", os.O_RDONLY)
    there = os.open(f"/run/netns/{namespace}", os.O_RDONLY)
    try:
        if libc.setns(there, CLONE_NEWNET) != 0:
            raise OSError(ctypes.get_errno(), f"setns {namespace}")
        port = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
        fcntl.ioctl(port, TUNSETIFF, struct.pack("16sH22x", interface.encode(), IFF_TAP | IFF_NO_PI))
        return port
    finally:
        libc.setns(here, CLONE_NEWNET)
        os.close(here)
        os.close(there)


class Way:
    """One direction of a link."""

    def __init__(self, deliver, chance: random.Random, agenda: list):
        self.deliver, self.chance, self.agenda = deliver, chance, agenda
        self.queues, self.waiting, self.busy = (deque(), deque(), deque()), [0, 0, 0], False
        self.state: dict = {}
        self.cut = False

    def send(self, frame: bytes, now: float) -> None:
        """Takes a frame in; it comes out later, twice or never."""
        if self.cut or self.chance.random() < self.state.get("loss", 0.0):
            return
        if "rate" in self.state:
            self._queue(frame, now)
            return
        copies = 2 if self.chance.random() < self.state.get("duplicate", 0.0) else 1
        for _ in range(copies):
            jitter = self.state.get("jitter", 0.0)
            delay = self.state.get("delay", 0.0) + self.chance.uniform(-jitter, jitter)
            if delay > 0.0:
                self._at(now + delay, lambda at: self.deliver(frame, at))
            else:
                self.deliver(frame, now)

    def _at(self, when: float, what) -> None:
        heapq.heappush(self.agenda, (when, self.chance.random(), what))

    def _queue(self, frame: bytes, now: float) -> None:
        # EtherType IPv4; the second byte of its header is the mark.
        mark = frame[15] >> 5 if frame[12:14] == b"\x08\x00" else 0
        number = 0 if mark >= URGENT else 2 if mark == LESS else 1
        if self.waiting[number] + len(frame) > QUEUE:
            return
        self.waiting[number] += len(frame)
        self.queues[number].append(frame)
        if not self.busy:
            self._next(now)

    def _next(self, now: float) -> None:
        number = next((number for number, queue in enumerate(self.queues) if queue), None)
        self.busy = number is not None
        if number is None:
            return
        frame = self.queues[number].popleft()
        self.waiting[number] -= len(frame)

        def sent(at: float) -> None:
            self.deliver(frame, at)
            self._next(at)

        # A link that is well again sends what waits at once.
        rate = self.state.get("rate", 1e9)
        self._at(now + 8.0 * len(frame) / rate, sent)


class Switch:
    """Links of hosts, and who is behind which."""

    def __init__(self, seed: int, hosts: list[str]):
        self.agenda: list = []
        self.ports: dict[int, str] = {}
        self.behind: dict[bytes, str] = {}
        self.parted: set[frozenset[str]] = set()
        self.to: dict[str, Way] = {}
        self.away: dict[str, Way] = {}
        chance = random.Random(seed)
        for host in hosts:
            namespace, interface, address = host.split(":")
            port = tap(namespace, interface)
            ip(namespace, "addr", "add", address, "dev", interface)
            ip(namespace, "link", "set", interface, "up")
            self.ports[port] = namespace
            self.to[namespace] = Way(lambda frame, _, port=port: put(port, frame), chance, self.agenda)
            forward = lambda frame, now, namespace=namespace: self.forward(namespace, frame, now)
            self.away[namespace] = Way(forward, chance, self.agenda)

    def forward(self, source: str, frame: bytes, now: float) -> None:
        """To whom it is for, or to all others."""
        known = self.behind.get(frame[:6])
        for name, way in self.to.items():
            if name != source and known in (None, name) and frozenset((source, name)) not in self.parted:
                way.send(frame, now)

    def set(self, change: dict) -> None:
        """Makes links bad or well."""
        if "parted" in change:
            self.parted = {frozenset(pair) for pair in change["parted"]}
        for name in change.get("links", []):
            self.to[name].state = self.away[name].state = change
            self.to[name].cut = change.get("cut") in ("to", "both")
            self.away[name].cut = change.get("cut") in ("from", "both")

    def run(self) -> None:
        """Until standard input ends."""
        poll = select.epoll()
        for port in [*self.ports, 0]:
            poll.register(port, select.EPOLLIN)
        rest = b""
        while True:
            patience = self.agenda[0][0] - time.monotonic() if self.agenda else 1.0
            for ready, _ in poll.poll(max(0.0, patience)):
                if ready:
                    self._take(ready)
                    continue
                said = os.read(0, 65536)
                if not said:
                    return
                *lines, rest = (rest + said).split(b"\n")
                for line in lines:
                    self.set(json.loads(line))
                    print("set", flush=True)
            while self.agenda and self.agenda[0][0] <= (now := time.monotonic()):
                heapq.heappop(self.agenda)[2](now)

    def _take(self, port: int) -> None:
        for _ in range(64):
            try:
                frame = os.read(port, 2048)
            except BlockingIOError:
                return
            self.behind[frame[6:12]] = self.ports[port]
            self.away[self.ports[port]].send(frame, time.monotonic())


def put(port: int, frame: bytes) -> None:
    """Writes to a host, which may have no room."""
    try:
        os.write(port, frame)
    except OSError:
        pass


def ip(namespace: str, *arguments: str) -> None:
    """Configures a namespace."""
    subprocess.run(["ip", "-n", namespace, *arguments], check=True)


if __name__ == "__main__":
    switch = Switch(int(sys.argv[1]), sys.argv[2:])
    print("ready", flush=True)
    switch.run()
