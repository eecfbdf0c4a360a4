"""Continuation of a periodic orbit from options, one of which is a range."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from rocking.cli.input.axis import VARIES, Range, check_displacement
from rocking.cli.input.options import question
from rocking.cli.option_names import RANGE_FORM, YourInput, computing, option, options, your_input

if TYPE_CHECKING:
    from rocking.model.block import Block
    from rocking.model.orbit import Orbit
    from rocking.model.system import State, System
    from rocking.orbits.branch import Branch

MAX_RESPONSE_PERIOD = 1000
GUESS = {
    "guess must": "the initial state must",
    "use a guess nearer": "give --angle and --velocity nearer",
    "another period": "another --response-period",
    "use a nearer guess": "give --angle and --velocity nearer to the orbit",
}
"""Words about the guess of `find_orbit` → words about the options that give it."""

FOLLOWED = dict.fromkeys(
    (
        "use a neighbouring one, branch.orbit(index), or find it again with find_orbit",
        "use a neighbouring one, or find it again with find_orbit",
    ),
    "give another --at",
)
"""Remedies of `continue_orbit` → the one on the command line."""


class Study(NamedTuple):
    """Branch to compute: the system at which the orbit is found, and the range of its varied parameter."""

    system: System
    start: State
    block: Block | None
    name: str  # varied option
    parameter: str
    bounds: tuple[float, float]
    typed: str


def study(given: Mapping[str, Any]) -> Study:
    """Return the study described by the options; YourInput unless exactly one of them is a range."""
    from rocking.model.system import quantities
    from rocking.model.validation import within

    ranges = [name for name, value in given.items() if isinstance(value, Range)]
    if len(ranges) != 1:
        got = " and ".join(map(option, ranges)) or "none"
        raise YourInput(f"exactly one option must be a range, {RANGE_FORM}; got {got}")
    name, (start, stop) = ranges[0], given[ranges[0]]
    check_displacement(given, name)
    # Valid ranges are intervals, so that two valid ends imply valid values between them.
    ends = [question({**given, name: value})[0] for value in (start, stop)]
    with your_input():
        at = start if given["at"] is None else within("--at", given["at"], *sorted((start, stop)))
    system, state, block = question({**given, name: at})
    parameter = VARIES.get(name, name)
    low, high = sorted(quantities(end)[parameter] for end in ends)
    typed = f"{option(name)} {start:.6g} to {stop:.6g}"
    return Study(system, state, block, name, parameter, (low, high), typed)


def compute(study: Study, response_period: int | None, step: float) -> tuple[Orbit, Branch]:
    """Return the orbit found and its branch; YourInput if there is none, or an argument is invalid."""
    from rocking.orbits.continuation import continue_orbit
    from rocking.orbits.parameter import check_range, check_step

    typed = FOLLOWED | {f"bounds of {study.parameter}": option(study.name)} | options("step")
    with your_input(typed):
        check_range(study.parameter, study.bounds)
        check_step(step)
    orbit = _approached(study) if response_period is None else _nearest(study, response_period)
    with computing(typed):
        return orbit, continue_orbit(orbit, study.parameter, study.bounds, step)


def _approached(study: Study) -> Orbit:
    """Return the orbit that the response from the initial state approaches."""
    from rocking.response.classify import classify

    with computing():
        verdict = classify(study.system, study.start)
    if verdict.orbit is None:
        raise YourInput(
            f"the response from the initial state must be periodic; got {verdict.kind} (give --response-period, "
            "another --at, or another --angle and --velocity)"
        )
    return verdict.orbit


def _nearest(study: Study, response_period: int) -> Orbit:
    """Return an orbit near the initial state with the response period wanted; YourInput if Newton's method finds none."""
    from rocking.model.validation import whole
    from rocking.orbits.find_orbit import find_orbit

    start = study.start
    given = {repr(start): f"--angle {start.angle:.6g} and --velocity {start.velocity:.6g}"}
    with computing(GUESS | given):
        period = whole("--response-period", response_period, 1, MAX_RESPONSE_PERIOD)
        orbit = find_orbit(study.system, start, period)
    if orbit.period != period:
        raise YourInput(
            f"the orbit found near the initial state must have --response-period {period}; got period {orbit.period} "
            "(give --angle and --velocity nearer to the orbit)"
        )
    return orbit
