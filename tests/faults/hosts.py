"""Hosts of a fault run: network namespaces on networks that can be bad (switch.py)."""

import json
import os
import subprocess
import sys
from pathlib import Path

# Where hosts run and how their nodes reach one another: `dds`, all on one network; `zenoh`, base station and robots in two
# networks, which a router alone joins; `radio`, all but the bridge on one host, by Zenoh through a router on either.
BASE, GATE, RADIO, ZENOH = "base", "gate", "radio", "zenoh"
# How the radio's router joins the base station's over a slow link (docs/hosts.md): little between the queues there and the wire.
SLOW_LISTENS = (
    "transport/link/tx/batch_size=600;transport/link/tx/queue/size/data=4;"
    'listen/endpoints=["tcp/[::]:7447","tcp/[::]:7448#so_sndbuf=1"]'
)
SLOW_CONNECTS = 'connect/endpoints=["tcp/10.77.0.1:7448#so_rcvbuf=4096"]'
INTERFACE = "eth0"
# Of TCP on every host, as docs/hosts.md has it for Zenoh.
SETTINGS = {
    "tcp_congestion_control": "reno", "tcp_rto_max_ms": 1000, "tcp_rto_min_us": 20000, "tcp_timestamps": 0, "tcp_frto": 0,
    "tcp_thin_linear_timeouts": 1,
}
# Where a round trip takes 0.2 s because the link is slow, what is on its way for 20 ms is not lost.
SETTINGS_SLOW = SETTINGS | {"tcp_rto_min_us": 200000}


class Hosts:
    """Namespaces and switches, which vanish with close()."""

    def __init__(self, kind: str, robots: list[str], seed: int):
        self.kind, self.prefix = kind, f"tf{os.getpid()}"
        self.switches: list[subprocess.Popen] = []
        self.of_link: dict[str, subprocess.Popen] = {}
        self.names = [BASE, RADIO] if kind == RADIO else [BASE, *robots, *([GATE] if kind == ZENOH else [])]
        try:
            for name in self.names:
                ip("netns", "add", self.namespace(name))
                ip("-n", self.namespace(name), "link", "set", "lo", "up")
                # Older kernels do not know all.
                for setting, value in (SETTINGS_SLOW if kind == RADIO else SETTINGS).items():
                    write = f"f=/proc/sys/net/ipv4/{setting}; [ ! -e $f ] || echo {value} > $f"
                    subprocess.run([*self.command(name), "sh", "-c", write], check=True)
            if kind != ZENOH:
                self._network(seed, "10.77.0", INTERFACE, self.names)
            else:
                self._network(seed, "10.78.0", INTERFACE, [BASE, GATE])
                self._network(seed + 1, "10.79.0", "eth1", [GATE, *robots])
        except BaseException:
            self.close()
            raise

    def namespace(self, name: str) -> str:
        """Of a host."""
        return self.prefix + name

    def _network(self, seed: int, network: str, gate_interface: str, hosts: list[str]) -> None:
        places = []
        for number, host in enumerate(hosts, 1):
            interface = gate_interface if host == GATE else INTERFACE
            places.append(f"{self.namespace(host)}:{interface}:{network}.{254 if host == GATE else number}/24")
        program = Path(__file__).with_name("switch.py")
        switch = subprocess.Popen(
            [sys.executable, str(program), str(seed), *places], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.switches.append(switch)
        if switch.stdout.readline() != "ready\n":
            raise RuntimeError("no network between hosts: see what the switch says above")
        for host in hosts:
            # DDS speaks to its multicast group on the way to everywhere; the way between the networks is not a host's.
            if host != GATE:
                ip("-n", self.namespace(host), "route", "add", "default", "dev", INTERFACE)
                self.of_link[host] = switch

    def environment(self, host: str) -> dict[str, str]:
        """What a process there must know: hosts share no memory, and by Zenoh all go through the router."""
        # Of twelve bytes at most, so that its files are found by it.
        own = {"TRENCH_SHM_PREFIX": f"{self.prefix}{host[:2]}{host[-1]}"}
        if self.kind == RADIO:
            own["RMW_IMPLEMENTATION"] = "rmw_zenoh_cpp"
        if self.kind == ZENOH:
            network = "10.78.0" if host == BASE else "10.79.0"
            own["RMW_IMPLEMENTATION"] = "rmw_zenoh_cpp"
            gate = f'mode="client";listen/endpoints=[];connect/endpoints=["tcp/{network}.254:7447"]'
            own["ZENOH_CONFIG_OVERRIDE"] = "" if host == GATE else gate
        return own

    def command(self, host: str) -> list[str]:
        """What stands in front of a command that runs there."""
        return ["ip", "netns", "exec", self.namespace(host)]

    def change(self, hosts: list[str], state: dict) -> None:
        """Makes the links of these hosts bad; with nothing, well."""
        for host in hosts:
            self._tell(self.of_link[host], state | {"links": [self.namespace(host)]})

    def part(self, pairs: list[list[str]]) -> None:
        """Lets nothing go between the two hosts of each pair, which stay joined to all others; with none, all are joined again."""
        for switch in self.switches:
            self._tell(switch, {"parted": [[self.namespace(host) for host in pair] for pair in pairs]})

    @staticmethod
    def _tell(switch: subprocess.Popen, change: dict) -> None:
        switch.stdin.write(json.dumps(change) + "\n")
        switch.stdin.flush()
        switch.stdout.readline()

    def close(self) -> None:
        """Takes all of it down."""
        for switch in self.switches:
            switch.stdin.close()
            switch.wait(10.0)
        for name in self.names:
            subprocess.run(["ip", "netns", "del", self.namespace(name)], check=False)


def ip(*arguments: str) -> None:
    """Configures the network."""
    subprocess.run(["ip", *arguments], check=True)
