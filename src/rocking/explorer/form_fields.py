"""Fields as text, in the form and in links: reading, validation and writing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any
from urllib.parse import urlencode

import attrs

from rocking.explorer.field_readers import (
    VERSION,
    WORDS,
    Refused,
    count,
    number,
    optional,
    parameters,
    read_fields,
    word,
    written,
)
from rocking.explorer.view_state import DEFAULT, Span, ViewState, closest
from rocking.model.block import Block
from rocking.model.quantity import AMPLITUDE, ANGLE, BRACE_ANGLE, CRITICAL_ANGLE, PERIOD, PHASE
from rocking.model.system import check_below_flat, check_start
from rocking.model.validation import Refusal
from rocking.plot import theory_curves

SAME = 1e-3
"""Largest relative difference at which a typed critical angle counts as that of the block in SI units."""
LATEST, MAX_SHOWN = 100_000, 200
"""Largest first cycle, and largest number of cycles, of the time history."""


def _span(low: float, high: float) -> Callable[[str, str], Span]:
    end = number(low, high)

    def read(name: str, text: str) -> Span:
        first, _, last = text.partition(":")
        span = Span(end(name, first), end(name, last))
        # tolerance for rounding, so that the narrowest range itself is valid
        if not span.width >= closest(span) * (1.0 - 1e-3):
            raise Refusal(
                name, "be LOW:HIGH, with LOW < HIGH and a range that double precision resolves", text
            )
        return span

    return read


def _words(*allowed: str) -> Callable[[str, str], tuple[str, ...]]:
    one = word(*allowed)

    def read(name: str, text: str) -> tuple[str, ...]:
        chosen = {one(name, each) for each in text.split(",") if each}
        return tuple(each for each in allowed if each in chosen)

    return read


START = -ANGLE.range[1], ANGLE.range[1]
READ: dict[str, Callable[[str, str], Any]] = {
    "amplitude": number(0.0, AMPLITUDE.range[1]),
    "period": number(*PERIOD.range),
    "restitution": number(0.0, 1.0),
    "phase": number(-PHASE.range[1], PHASE.range[1]),
    "angle": number(*START),
    "velocity": number(*START),
    "brace_angle": optional(number(*BRACE_ANGLE.range)),
    "brace_restitution": number(0.0, 1.0),
    "critical_angle": optional(number(*CRITICAL_ANGLE.range)),
    "amplitudes": _span(0.0, AMPLITUDE.range[1]),
    "periods": _span(*PERIOD.range),
    "angles": _span(*START),
    "velocities": _span(*START),
    "vary": word("amplitude", "period"),
    "first": count(0, LATEST),
    "cycles": count(1, MAX_SHOWN),
    "curves": _words(*theory_curves.CURVES),
    "height": optional(number(1e-3, 1e3)),
    "width": optional(number(1e-3, 1e3)),
}
"""Reader of each field, for the form and for links."""
PHYSICAL = {
    "height": number(1e-3, 1e3),
    "width": number(1e-3, 1e3),
    "acceleration": number(0.0, 1e6),
    "frequency_hz": number(1e-6, 1e6),
}


def changed(shown: ViewState, typed: Mapping[str, str]) -> ViewState:
    """Return the view with new values of some fields.

    Parameters
    ----------
    shown : ViewState
        Current view.
    typed : mapping of str to str
        Field names and their text.

    Returns
    -------
    ViewState
        New view.

    Raises
    ------
    Refused
        If a field is invalid, with one message per field.
    """
    read, refused = read_fields(READ, typed)
    if refused:
        raise Refused(refused)
    return _checked(_with_angle_of_block(attrs.evolve(shown, **read)))


def _with_angle_of_block(shown: ViewState) -> ViewState:
    """Return the view with the exact critical angle of its block in SI units; raise Refused for another one."""
    if shown.block is None or shown.critical_angle is None:
        return shown
    exact = shown.block.critical_angle
    if abs(shown.critical_angle / exact - 1.0) > SAME:
        allowed = f"be {exact:.4g}, that of the block in SI units, or empty"
        raise Refused({"critical_angle": str(Refusal("critical angle", allowed, shown.critical_angle))})
    return attrs.evolve(shown, critical_angle=exact)


def _checked(shown: ViewState) -> ViewState:
    """Return the view; raise Refused for braces or an initial state that its block cannot have."""
    if shown.critical_angle is not None and shown.brace_angle is not None:
        try:
            check_below_flat(shown.brace_angle, shown.critical_angle)
        except Refusal as error:
            raise Refused(_at_its_field(error)) from None
    try:
        check_start(shown.system, shown.start)
    except ValueError as error:
        raise Refused({"angle": str(error)}) from None
    return shown


def in_metres(shown: ViewState, typed: Mapping[str, str]) -> ViewState:
    """Return the view with a block and its forcing in SI units.

    Parameters
    ----------
    shown : ViewState
        Current view.
    typed : mapping of str to str
        Text of `height` and `width` in m, `acceleration` in the `unit` "g" or "m/s²", and `frequency_hz` in Hz.

    Returns
    -------
    ViewState
        New view, with Housner's coefficient of restitution. Its map includes the new system. A critical angle becomes that
        of the block.

    Raises
    ------
    Refused
        If a field is invalid, with one message per field.
    """
    read, refused = read_fields(PHYSICAL, {name: typed.get(name, "") for name in PHYSICAL})
    if refused:
        raise Refused(refused)
    size = "acceleration_g" if typed.get("unit") == "g" else "acceleration"
    try:
        block = Block(read["height"], read["width"])
        system = block.system(**{size: read["acceleration"]}, frequency_hz=read["frequency_hz"])
    except Refusal as error:
        raise Refused(_at_its_field(error)) from None
    forcing = system.periodic
    wanted = attrs.evolve(
        shown,
        amplitude=forcing.amplitude,
        period=forcing.period,
        restitution=system.restitution,
        height=block.height,
        width=block.width,
        critical_angle=None if shown.critical_angle is None else block.critical_angle,
        amplitudes=_reaching(shown.amplitudes, forcing.amplitude, AMPLITUDE.range[1]),
        periods=_reaching(shown.periods, forcing.period, PERIOD.range[1]),
    )
    return _checked(wanted)


def _at_its_field(error: Refusal) -> dict[str, str]:
    """Return the message of a refused argument by its field, with the label of the field."""
    if error.argument == "restitution":  # Housner's value, which follows from height and width
        return at_width(error)
    return {error.argument.removesuffix("_g"): str(error.of(WORDS))}


def at_width(error: Refusal) -> dict[str, str]:
    """Return the message of a refused restitution of Housner by the field of the width."""
    remedy = "make the block narrower or taller"
    return {"width": str(Refusal(error.argument, error.allowed, error.value, remedy))}


def _reaching(span: Span, value: float, most: float) -> Span:
    """Return the range, extended if necessary to contain a value."""
    if span.low <= value <= span.high:
        return span
    return Span(min(span.low, value * 0.8), min(max(span.high, value * 1.25), most))


def address(shown: ViewState) -> str:
    """Return the query string of a view: the system, and all other fields that differ from their defaults."""
    system = ("amplitude", "period", "restitution")
    parts = {
        each.name: written(getattr(shown, each.name))
        for each in attrs.fields(ViewState)
        if each.name in system or getattr(shown, each.name) != each.default
    }
    return urlencode({"version": str(VERSION)} | parts, safe=":,")


def from_address(text: str) -> tuple[ViewState, dict[str, str]]:
    """Return the view of a query string; invalid parameters keep their defaults.

    Returns
    -------
    tuple of (ViewState, dict of str)
        View, and an error message for each invalid parameter.
    """
    try:
        typed = parameters(text)
    except Refused as unread:
        return DEFAULT, unread.fields
    read, refused = read_fields(READ, typed)
    while True:
        try:
            return _checked(_with_angle_of_block(attrs.evolve(DEFAULT, **read))), refused
        except Refused as unfit:
            refused |= unfit.fields
            read = {name: value for name, value in read.items() if name not in unfit.fields}
