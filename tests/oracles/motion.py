"""The whole block by brute force: textbook closed form, dense scan, bracketed roots, many digits.

Times add up from the start, events are searched sample by sample, and chattering is followed impact by impact down to
1e-24. The slow and plain method shares nothing with the package except the equations of motion.
"""

from dataclasses import dataclass

import numpy as np
from flint import arb, ctx

from oracles.scan import next_event

STILL = arb(10) ** -24  # speed at which chatter counts as finished


@dataclass
class Result:
    """State after the last cycle (arb), counts of the events after the start, and how far a small error can have grown.

    growth is the largest norm, over all events before the end, of the tangent from just after that event to the end.
    """

    angle: arb
    velocity: arb
    counts: dict
    growth: float
    overturned: bool


class Block:
    """One system and its state; all numbers are balls used as plain numbers (their middles)."""

    def __init__(self, case, scan):
        self.amplitude, self.restitution, self.now = arb(case["A"]), arb(case["e"]), arb(0)
        self.phase, self.scan = arb(case["phi"]), scan
        self.brace = None if case["brace"] is None else arb(case["brace"])
        self.brace_restitution = None if case["r"] is None else arb(case["r"])
        self.angle, self.velocity = arb(case["Theta0"]), arb(case["dTheta0"])
        self.end = case["N"] * arb(case["T"])
        self.drive(2 * arb.pi() / arb(case["T"]))
        self.rate = 1.25 if scan == 1 else 1 + 0.25 / scan
        self.counts = dict.fromkeys(("impact", "brace", "rest", "lift-off", "lean", "leave"), 0)
        self.tangents, self.overturned = [], False

    def drive(self, frequency):
        """Set the forcing's frequency, and with it the spacing of samples: 60 a period and 60 a time constant at least."""
        self.frequency = frequency
        self.ripple = self.amplitude / (1 + frequency**2)
        self.coarsest = (min(arb(1), 2 * arb.pi() / frequency) / (60 * self.scan)).mid()

    def force(self, time):
        """A cos ψ."""
        return self.amplitude * (self.frequency * time + self.phase).cos()

    def arc(self, side):
        """Θ and Θ' as functions of the time since now, eq. (5): sides ±1 are the two signs of Θ."""
        psi = self.frequency * self.now + self.phase
        swing, spin = self.ripple * psi.cos(), self.ripple * self.frequency * psi.sin()
        grow = (self.angle - side - swing + self.velocity + spin) / 2
        decay = (self.angle - side - swing - self.velocity - spin) / 2

        def motion(time):
            out, turn = time.exp(), psi + self.frequency * time
            sine, cosine = turn.sin_cos()
            return (
                side + self.ripple * cosine + grow * out + decay / out,
                -self.ripple * self.frequency * sine + grow * out - decay / out,
            )

        return motion, grow * side

    def step_start(self):
        """A first sample well inside the shortest arc that this speed allows."""
        pull = 1 + self.amplitude + abs(self.angle)
        return min(
            self.coarsest, abs(self.velocity) / pull / 20 if self.velocity != 0 else self.coarsest / 1000
        )

    def count(self, kind):
        if self.now > 0:
            self.counts[kind] += 1


def _advance(block, motion, time):
    """Move to a time since now along an arc, with its tangent."""
    angle, velocity = motion(time)
    sinh, cosh = (float(value) for value in time.sinh_cosh())
    block.tangents.append(np.array([[cosh, sinh], [sinh, cosh]]))
    block.now = (block.now + time).mid()
    block.angle, block.velocity = angle.mid(), velocity.mid()


def _impact(block, side):
    """Eq. (2), and what follows it: the other side, or rest."""
    before, force = block.velocity, block.force(block.now)
    block.angle, block.velocity = arb(0), block.restitution * before
    block.count("impact")
    if abs(block.velocity) < STILL and abs(force) < 1:
        return "rest", 0
    onto = -side if block.velocity != 0 else (-1 if force > 0 else 1)
    bend = (-force - onto) - block.restitution * (-force - side)
    _event_tangent(block, block.restitution, float(bend / before))
    return "moving", onto


def _brace_impact(block, side):
    """Θ' → −rΘ', or leaning where the rebounds have died out against an outward pull."""
    before, pull = block.velocity, block.brace - 1 - side * block.force(block.now)
    block.angle, block.velocity = side * block.brace, -block.brace_restitution * before
    block.count("brace")
    if abs(block.velocity) < STILL and pull > 0:
        return "leaning", side
    _event_tangent(
        block, -block.brace_restitution, float((1 + block.brace_restitution) * side * pull / before)
    )
    return "moving", side


def _event_tangent(block, restitution, bend):
    """Put the event onto the arc that ends in it, so that products of the list start just after events."""
    block.tangents[-1] = (
        np.array([[float(restitution), 0.0], [bend, float(restitution)]]) @ block.tangents[-1]
    )


def _wait(block, level, half_turns):
    """Stay until cos ψ rises through a level, or (half_turns) |cos ψ| does; False if that is beyond the end."""
    block.tangents.append(np.zeros((2, 2)))
    if abs(level) >= 1:
        return False
    spacing = arb.pi() * (1 if half_turns else 2)
    psi, target = block.frequency * block.now + block.phase, -level.acos()
    turns = ((psi - target) / spacing).ceil()
    block.now = ((target + spacing * turns - block.phase) / block.frequency).mid()
    return bool(block.now < block.end)


def _rest(block):
    """At rest on the base until |A cos ψ| rises through 1."""
    block.count("rest")
    block.angle = block.velocity = arb(0)
    if not (block.amplitude > 1 and _wait(block, 1 / block.amplitude, True)):
        block.tangents.append(np.zeros((2, 2)))
        return None
    block.count("lift-off")
    return "moving", -1 if block.force(block.now) > 0 else 1


def _lean(block, side):
    """At rest on a brace until the pull outward ends: side·cos ψ rises through (Θb − 1)/A."""
    block.count("lean")
    block.angle, block.velocity = side * block.brace, arb(0)
    level = (block.brace - 1) / block.amplitude if block.amplitude > 0 else arb(2)
    shift = arb(0) if side > 0 else arb.pi()
    block.phase += shift
    leaves = _wait(block, level, False)
    block.phase -= shift
    if not leaves:
        return None
    block.count("leave")
    return "moving", side


def _begin(block):
    """The first mode: moving onto a side, at rest, or leaning."""
    force = block.force(block.now)
    if block.angle == 0 and block.velocity == 0:
        return ("rest", 0) if abs(force) <= 1 else ("moving", -1 if force > 0 else 1)
    side = 1 if (block.angle if block.angle != 0 else block.velocity) > 0 else -1
    if block.brace is not None and abs(block.angle) == block.brace and block.velocity == 0:
        return ("leaning" if block.brace - 1 - side * force > 0 else "moving"), side
    return "moving", side


def _march(block):
    mode = _begin(block)
    while mode is not None:
        name, side = mode
        if name == "rest":
            mode = _rest(block)
        elif name == "leaning":
            mode = _lean(block, side)
        else:
            motion, growing = block.arc(side)
            time, kind = next_event(block, motion, side, growing)
            if time is None:
                if not block.overturned:
                    _advance(block, motion, block.end - block.now)
                return
            _advance(block, motion, time)
            mode = _impact(block, side) if kind == "impact" else _brace_impact(block, side)


def _growth(tangents):
    largest, product = 1.0, np.eye(2)
    for matrix in reversed(tangents):
        product = product @ matrix
        largest = max(largest, float(np.linalg.norm(product, 2)))
    return largest


def first_crossing(arc, digits=100):
    """Return (kind, time) of the first event of an `oracles.distance.Arc`; kind "base", "brace" or "none"."""
    before = ctx.dps
    ctx.dps = digits
    try:
        braced = arc.brace < float("inf")
        start = {"phi": arc.phase, "Theta0": arc.side * arc.angle, "dTheta0": arc.side * arc.velocity, "N": 1}
        system = {
            "A": arc.amplitude,
            "T": 1.0,
            "e": 1.0,
            "brace": arc.brace if braced else None,
            "r": 1.0 if braced else None,
        }
        block = Block(start | system, 1)
        block.drive(arb(arc.frequency))
        block.end = arb(200)
        motion, growing = block.arc(arc.side)
        time, kind = next_event(block, motion, arc.side, growing)
        return {"impact": "base", "brace": "brace", None: "none"}[kind], time
    finally:
        ctx.dps = before


def simulate(case, digits=80, scan=1):
    """Run a case (a mapping with the keys of `states.json`) to its N-th cycle; scan multiplies the density of samples."""
    before = ctx.dps
    ctx.dps = digits
    try:
        block = Block(case, scan)
        _march(block)
        return Result(block.angle, block.velocity, block.counts, _growth(block.tangents), block.overturned)
    finally:
        ctx.dps = before
