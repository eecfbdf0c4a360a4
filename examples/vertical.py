"""What the vertical component of a ground motion changes: the verdicts on two blocks under eight pairs of channels.

Run ``python examples/vertical.py FOLDER``. The folder holds the four record files of ``FILES``, which the package must not pass on. Each
horizontal channel is followed with and without the vertical channel of its file. The strong part of a pair reaches from the first to the
last horizontal |acceleration| of 5 % of the peak. The factors of both components are those by which the horizontal peak becomes 1.1 to 5
times the acceleration of lift-off.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import rocking as rk

FILES = ("20161113_110259_WTMC_20.V2A", "CICCC.RAW", "CICLC.v1", "ce36456p_CE36456.V2")
"""GeoNet: Kaikōura 2016, Te Mara Farm; CSMIP: Ridgecrest 2019, CCC and CLC; Coalinga 1983, Parkfield Fault Zone 14."""
BLOCKS = (rk.Block(2.0, 0.6), rk.Block(1.0, 0.3))
LEVELS = np.linspace(1.1, 5.0, 40)
"""Horizontal peak over the acceleration of lift-off."""
STRONG = 0.05
"""Share of the horizontal peak at which the strong part begins and ends."""


def pairs(path):
    """Yield the strong parts of each horizontal channel of a file, with that of the vertical channel."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        motions = rk.read_ground_motions(path)
    (up,) = (each for each in motions if each.vertical)
    for ground in motions:
        if not ground.vertical:
            strong = ground.times[np.abs(ground.acceleration) >= STRONG * ground.pga]
            part = strong[0], min(strong[-1], up.duration, ground.duration)
            yield ground.clipped(*part), up.clipped(*part)


def outcome(system):
    """Return whether the block overturns; None if it leaves the base."""
    try:
        return rk.simulate(system, record="none").outcome is rk.Outcome.OVERTURNED
    except rk.ContactLost:
        return None


def compared(block, both):
    """Return the outcomes (n, levels) without and with the vertical component."""
    lift_off = 9.80665 * np.tan(block.critical_angle)
    rows = []
    for ground, up in both:
        for level in LEVELS:
            factor = level * lift_off / ground.pga
            moved = ground.scaled(factor)
            rows.append([outcome(block.system(moved, vertical=each)) for each in (None, up.scaled(factor))])
    return rows


def main(folder):
    """Print the files, and a line for each block."""
    both = []
    for name in FILES:
        found = list(pairs(Path(folder) / name))
        both += found
        print(f"{name}, SHA-256 {found[0][0].file.sha256}")
        for ground, up in found:
            ends = ", ".join(f"{each.component} {each.pga / 9.80665:.3f} g" for each in (ground, up))
            print(f"  {ends}, {ground.duration:.2f} s")
    for block in BLOCKS:
        rows = compared(block, both)
        kept = [(without, under) for without, under in rows if under is not None]
        print(
            f"{block.height} m × {block.width} m: {len(rows)} runs, {len(rows) - len(kept)} leave the base; of the other {len(kept)}, "
            f"{sum(one != other for one, other in kept)} verdicts differ, "
            f"{sum(one for one, _ in kept)} overturn without and {sum(other for _, other in kept)} with the vertical component"
        )


if __name__ == "__main__":
    main(sys.argv[1])
