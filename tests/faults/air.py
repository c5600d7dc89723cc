"""Whether the command links say of the air what the matrix says."""

from bag import Run, Series

# How many hops there are to a robot of which the base station or who hears it only through others; for which share of the time that must be so.
RELAYED, MOSTLY = 2, 0.8
# The share of the packets of a second that a robot misses in which there was a burst of interference.
BURST = 0.12


def air(bag: Run, fault: dict, began: float, ended: float) -> list[str]:
    """What the command links must say of the air, so that the matrix does what it says: with `relayed` this robot, and with `bursts` all together at least so
    often, were out of reach."""
    problems = []
    if robot := fault.get("relayed"):
        # A packet that was lost on its own way may come through others to who is near, too: once in a while.
        shares = {name: relayed_share(series, began, ended) for name, series in bag.links.items()}
        if shares.get(robot, 0.0) < MOSTLY:
            problems.append(f"{robot} was reached through others for {shares.get(robot, 0.0):.0%} of the time only")
        problems += [f"{other} was out of reach, too" for other, share in sorted(shares.items()) if other != robot and share > 1.0 - MOSTLY]
    if "bursts" in fault:
        # Where each robot's second was bad at once nobody heard anybody.
        times = [at for series in list(bag.links.values())[:1] for at, _ in series.between(began, ended)]
        together = [all((series.at(at) or (True, 0.0, 1))[1] > BURST for series in bag.links.values()) for at in times]
        met = sum(now and not before for before, now in zip([False, *together], together))
        if met < fault["bursts"]:
            problems.append(f"there were {met} bursts of interference, not {fault['bursts']}")
    return problems


def relayed_share(links: Series, began: float, ended: float) -> float:
    """For which share of the time a command link went through others."""
    hops = [hops for _, (up, _, hops) in links.between(began, ended) if up]
    return sum(count >= RELAYED for count in hops) / len(hops) if hops else 0.0
