"""From the options of a command to the arguments of its function."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from attrs import Factory, evolve, frozen

from rocking.cli.options import (
    AMPLITUDES,
    AXIS_FORM,
    MASS_CENTRE,
    NORMALISED,
    RANGE_FORM,
    RESTRAINER,
    SI,
    STANDING,
    START,
    SURVEYED,
    SYSTEM,
    Axis,
    InvalidInput,
    Range,
    lines_of,
    number_in,
    option,
    refusals,
)
from rocking.model.block import Block
from rocking.model.block_formulas import with_unit
from rocking.model.forcing import Harmonic, Pulse
from rocking.model.quantity import FRICTION, SYSTEM_QUANTITIES
from rocking.model.restitution import Restitution
from rocking.model.restrainer import Restrainer
from rocking.model.system import NO_BRACES, Braces, State, System, Wall, normalisation_for
from rocking.model.system import quantities as quantities_of
from rocking.model.system import system_of as system_with
from rocking.model.validation import NoOrbit, Refusal, whole, within

if TYPE_CHECKING:
    from rocking.model.orbit import Orbit
    from rocking.orbits.branch import Branch

IN_SI = {"amplitude": "acceleration", "period": "period_s", "frequency": "frequency_hz"}
VARIES = dict.fromkeys(AMPLITUDES, "amplitude") | {"frequency_hz": "frequency", "period_s": "period"}
"""Option → the normalised quantity that it varies."""
NORMALISED_NEEDS = "--amplitude, --period (or --frequency) and --restitution"
SI_NEEDS = "--height, --width, --acceleration (or --acceleration-g, --displacement) and --frequency-hz (or --period-s)"
OUTPUTS = ("plot", "animate", "csv", "netcdf", "tiles")
LAWS = ("restitution_factor", "restitution_table", "restitution_scatter")
OTHER = {
    *LAWS,
    *SYSTEM,
    *RESTRAINER,
    *START,
    *OUTPUTS,
    "model",
    "normalised_by",
    "friction",
    "study",
    "json",
    "pulse",
    "curves",
    "symbols",
    "sources",
    "hazard",
}
"""Options that are no arguments of a function under their own names."""
NO_UNIT = "--normalised-by needs a block in SI: omit it with normalised input"
DEFAULT_MODES = (1, 3)
STARTS = 200
"""Default number of initial states along an axis of a grid."""
Options = Mapping[str, Any]


@frozen
class Request:
    """Request of a computation: the arguments of its function, and what its report needs."""

    arguments: dict[str, Any]
    options: Options
    block: Block | None = None
    names: dict[str, str] = Factory(dict)
    """Arguments in messages → names of options, where these differ."""
    warnings: list[str] = Factory(list)
    """Warnings of the reader of records."""
    varied: str = ""
    """Option with an axis or a range, as typed."""
    records: Any = None
    vertical: Any = None
    """Vertical component of a record."""
    hazard: Any = None
    """Hazard of the site of a fragility, a `HazardCurve`."""
    counted: str = ""
    """Direction of a record that counts, "+" or "-", where both were followed."""


def own_arguments(options: Options) -> dict[str, Any]:
    """Return the options that are arguments of a function under their own names."""
    return {name: value for name, value in options.items() if name not in OTHER}


# One system.


def normalised_and_si(options: Options) -> tuple[list[str], list[str]]:
    """Return the names of the given normalised options and SI options; InvalidInput if both kinds are given."""
    normalised, physical = ([name for name in kind if name in options] for kind in (NORMALISED, SI))
    if normalised and physical:
        name = normalised[0]
        raise InvalidInput(
            f"{option(name)} is normalised and {option(physical[0])} is SI: use one of the two (the SI option is {option(IN_SI[name])})"
        )
    return normalised, physical


def require(options: Options, groups: Iterable[tuple[str, ...]], needs: str) -> None:
    """Raise InvalidInput if all options of a group are missing; each group needs one of its options."""
    missing = [option(group[0]) for group in groups if not any(name in options for name in group)]
    if missing:
        lacks = " and ".join(missing)
        raise InvalidInput(f"missing {lacks}" if lacks == needs else f"missing {lacks}: give {needs}")


def system_of(options: Options) -> tuple[System, Block | None]:
    """Return the system and, with SI input, the block of the options; InvalidInput if invalid."""
    normalised, physical = normalised_and_si(options)
    if not normalised and not physical:
        raise InvalidInput(f"no system is given: give {NORMALISED_NEEDS}, or in SI {SI_NEEDS}")
    if normalised:
        require(options, (("amplitude",), ("period", "frequency"), ("restitution",)), NORMALISED_NEEDS)
        for name in select(options, *STANDING):
            raise InvalidInput(f"{option(name)} needs a block in SI: give --height and --width")
        if "model" in options:
            raise InvalidInput("--model needs a block in SI: give --critical-angle with normalised input")
        if "normalised_by" in options:
            raise InvalidInput(NO_UNIT)
        if laws := select(options, *LAWS):
            raise InvalidInput(f"{option(next(iter(laws)))} needs a block in SI: give --height and --width")
    else:
        require(options, (("height",), ("width",), SI[2:5], SI[5:]), SI_NEEDS)
        if "critical_angle" in options:
            raise InvalidInput("--critical-angle is normalised: with --height and --width give --model full")
    braces = braces_of(options)
    with refusals({"kind": "--pulse", "stiffness": "--restrainer-stiffness"}):
        if normalised:
            block = None
            forcing = Harmonic(**select(options, *NORMALISED, "phase"))
            system = System(
                forcing, options["restitution"], braces, critical_angle=options.get("critical_angle")
            )
        else:
            block = Block(
                options["height"],
                options["width"],
                restitution_of(options),
                **standing_of(options),
            )
            base = select(options, *SI[2:], "phase")
            by = {} if "pulse" in options else select(options, "normalised_by")
            free = evolve(block, restrainer=None) if "pulse" in options else block
            system = free.system(**base, braces=braces, model=model_of(options), **by)
        if "pulse" in options:
            system = pulsed(system, options, block)
        return system, system.block


def model_of(options: Options) -> str:
    """Return the equation of motion of a block in SI: by default full under a pulse, slender on a harmonic base."""
    return str(options.get("model", "full" if "pulse" in options else "slender"))


def select(options: Options, *names: str) -> dict[str, Any]:
    """Return the options among `names`."""
    return {name: options[name] for name in names if name in options}


def restitution_of(options: Options) -> float | Restitution | None:
    """Return the restitution of a block of the options; InvalidInput if invalid."""
    given = [name for name in ("restitution", *LAWS) if name in options]
    alone = [name for name in given if name != "restitution_scatter"]
    if "wall" in options:
        alone = [*given, "wall"]
    if len(alone) > 1:
        raise InvalidInput(f"give {option(alone[0])} or {option(alone[1])}, not both")
    if not given:
        return None
    names = {"rows": "restitution_table", "factor": "restitution_factor", "value": "restitution"}
    typed = {name: option(each) for name, each in names.items()}
    typed |= {name: f"the {name} of --restitution-scatter" for name in ("deviation", "shape", "seed")}
    with refusals(typed):
        if "restitution_table" in options:
            law = Restitution.table(options["restitution_table"])
        elif "restitution" in options:
            law = Restitution.constant(options["restitution"])
        else:
            law = Restitution.housner(options.get("restitution_factor", 1.0))
        return law.scattered(*options["restitution_scatter"]) if "restitution_scatter" in options else law


def fit_restitution(options: Options) -> Request:
    """Return the request of a fit of the coefficient of restitution."""
    with refusals():
        lines = lines_of("FILE", options["times"])
    texts = [
        part for line in lines if not line.startswith("#") for part in re.split(r"[,;\s]+", line) if part
    ]
    times = [number_in(part) for part in texts]
    if None in times:
        raise InvalidInput(f"FILE must hold times in s, and lines with #; got {texts[times.index(None)]!r}")
    block = None
    if {"height", "width"} & options.keys():
        require(options, (("height",), ("width",)), "--height and --width")
        with refusals():
            block = Block(options["height"], options["width"], 0.5)
    arguments = select(options, "frequency_parameter", "angle", "release", "model")
    return Request(
        {"times": times, "block": block} | arguments,
        options,
        block,
        {"times": "FILE", "block": "--height and --width"},
    )


def pulsed(system: System, options: Options, restrained: Block | None) -> System:
    """Return a system with one pulse of the amplitude and the period of its harmonic base motion; of the ``restrained`` block if it is."""
    for name in ("phase", "displacement"):
        if options.get(name):
            raise InvalidInput(f"{option(name)} belongs to harmonic motion: omit it with --pulse")
    part = 0.5 if options["pulse"] == "half-sine" else 1.0
    wave, block = system.forcing, by_normalisation(system.block, options)
    assert isinstance(wave, Harmonic)
    if restrained is not None and restrained.restrainer is not None:
        size, time = restrained.acceleration(wave.amplitude), restrained.seconds(part * wave.period)
        pulse = Pulse(options["pulse"], amplitude=size, duration=time)
        by = select(options, "normalised_by")
        return restrained.system(pulse, braces=system.braces, model=model_of(options), **by)
    amplitude = wave.amplitude * unit_ratio(block)
    forcing = Pulse(options["pulse"], amplitude=amplitude, duration=part * wave.period)
    return evolve(system, forcing=forcing, block=block)


def by_normalisation(block: Block | None, options: Options) -> Block | None:
    """Return the block under a pulse, with the unit of acceleration of the options; None for normalised input."""
    if block is None:
        return None
    by = normalisation_for(options.get("normalised_by"), model_of(options))
    return with_unit(block, by)


def unit_ratio(block: Block | None) -> float:
    """Return g θcr in units of the acceleration of a block; 1 for normalised input."""
    if block is None:
        return 1.0
    return block.critical_angle / block.acceleration_unit_g


def standing_of(options: Options) -> dict[str, Any]:
    """Return the arguments of a block that place its mass centre, state its inertia, and put it against a wall."""
    given = select(options, *MASS_CENTRE, "wall")
    if "wall" in given:
        with refusals({"restitution": option("wall")}):
            given["wall"] = Wall(given["wall"])
    return given | restrainer_of(options)


def restrainer_of(options: Options) -> dict[str, Any]:
    """Return the restrainer of the options as an argument of a block; none without its stiffness or its force."""
    given = select(options, *RESTRAINER)
    if not given:
        return {}
    require(options, (RESTRAINER[:2], ("mass",)), "--restrainer-stiffness and --mass")
    if "friction" in options:
        raise InvalidInput("--friction must be omitted for a restrained block, whose sliding is not checked")
    if "vertical" in options:
        raise InvalidInput("--vertical must be omitted for a restrained block")
    names = {name.removeprefix("restrainer_"): option(name) for name in RESTRAINER}
    with refusals(names):
        values = {"restrainer_stiffness": 0.0, "restrainer_prestress": 0.0} | given
        return {"restrainer": Restrainer(*(values[name] for name in RESTRAINER))}


def braces_of(options: Options) -> Braces | None:
    """Return the braces of the options, if there are any; InvalidInput if invalid."""
    if "brace_angle" not in options:
        if "brace_restitution" in options:
            raise InvalidInput("--brace-restitution needs --brace-angle")
        return None
    with refusals({"angle": option("brace_angle"), "restitution": option("brace_restitution")}):
        return Braces(options["brace_angle"], options.get("brace_restitution", 1.0))


def start_of(options: Options) -> State:
    """Return the initial state of the options."""
    with refusals():
        return State(*(SYSTEM_QUANTITIES[name].checked(options.get(name, 0.0)) for name in START))


def response(options: Options) -> Request:
    """Return the request of a function of a system and an initial state."""
    request = one_system(options)
    return Request(request.arguments | {"start": start_of(options)}, options, request.block)


def one_system(options: Options) -> Request:
    """Return the request of a function of a system."""
    arguments = own_arguments(options)
    system, block = system_of(options)
    return Request({"system": system} | arguments, options, block)


def simulation(options: Options) -> Request:
    """Return the request of a simulation."""
    from rocking.cli.reports_motion import MAX_CYCLES_KEPT

    cycles = options.get("cycles", None if "pulse" in options else 200)
    if "pulse" in options and cycles is not None:
        raise InvalidInput("--cycles belongs to harmonic motion: omit it with --pulse")
    files = tuple(name for name in (*OUTPUTS, "friction") if name in options)
    if files and cycles is not None and cycles > MAX_CYCLES_KEPT:
        names = ", ".join(map(option, files))
        raise InvalidInput(f"--cycles must be at most {MAX_CYCLES_KEPT} with {names}; got {cycles}")
    system, block = system_of(options)
    if "friction" in options and block is None:
        raise InvalidInput("--friction needs a block in SI: give --height and --width")
    check_friction(options)
    return Request(
        {"system": system, "start": start_of(options), "cycles": cycles, "files": files}, options, block
    )


def check_friction(options: Options) -> None:
    """Raise InvalidInput for a coefficient of friction outside its range."""
    with refusals():
        if "friction" in options:
            FRICTION.checked(options["friction"])


# One varied quantity of a system.


class Varied(NamedTuple):
    """Quantity that one option varies, and the systems at both ends."""

    name: str  # option
    parameter: str
    first: System
    last: System
    block: Block | None


def varied_of(options: Options, kind: type, form: str) -> Varied:
    """Return the quantity that exactly one option varies, as an axis or a range; InvalidInput for another number of them."""
    article = "an axis" if kind is Axis else "a range"
    names = [name for name, value in options.items() if isinstance(value, kind)]
    if len(names) != 1:
        got = " and ".join(map(option, names)) or "none"
        raise InvalidInput(f"exactly one option must be {article}, {form}; got {got}")
    (name,) = names
    if "displacement" in options and name in ("frequency_hz", "period_s"):
        raise InvalidInput(
            f"--displacement with {article} of {option(name)} varies amplitude and frequency: use --acceleration instead"
        )
    check_both_sides(options)
    # Valid ranges are intervals, so that two valid ends imply valid values between them.
    first, block = system_of({**options, name: options[name].start})
    last, _ = system_of({**options, name: options[name].stop})
    return Varied(name, VARIES.get(name, name), first, last, block)


def check_both_sides(options: Options) -> None:
    """Raise InvalidInput for a coefficient of restitution that varies with an offset, where each side has its own one."""
    if options.get("offset") and isinstance(options.get("restitution"), Axis | Range | np.ndarray):
        raise InvalidInput("--restitution with --offset must be a number, because each side has its own one")


def ends_of(varied: Varied) -> tuple[float, float]:
    """Return the first and the last value of a quantity of the forcing."""
    return getattr(varied.first.periodic, varied.parameter), getattr(varied.last.periodic, varied.parameter)


def varied_text(name: str, value: Axis | Range) -> str:
    """Return an option with an axis or a range, as text."""
    return f"{option(name)} {value.start:.6g} to {value.stop:.6g}"


def continuation(options: Options) -> Request:
    """Return the request of a branch of orbits: exactly one option is a range."""
    varied = varied_of(options, Range, RANGE_FORM)
    ends = options[varied.name]
    with refusals():
        at = within("--at", options["at"], *sorted(ends)) if "at" in options else ends.start
    system, block = system_of({**options, varied.name: at})
    arguments = {
        "system": system,
        "start": start_of(options),
        "parameter": varied.parameter,
        "bounds": tuple(sorted(quantities_of(end)[varied.parameter] for end in (varied.first, varied.last))),
        "step": options["step"],
        "response_period": options.get("response_period"),
        "name": option(varied.name),
    }
    return Request(arguments, options, block, varied=varied_text(varied.name, options[varied.name]))


class Followed(NamedTuple):
    """Orbit and its branch."""

    orbit: Orbit
    branch: Branch


MAX_RESPONSE_PERIOD = 1000


def follow(
    system: System,
    start: State,
    parameter: str,
    bounds: tuple[float, float],
    step: float,
    response_period: int | None,
    name: str,
) -> Followed:
    """Return an orbit and its branch; InvalidInput if there is none, or an argument is invalid. `name` is the option varied."""
    from rocking.orbits.continuation import continue_orbit
    from rocking.orbits.parameter import check_range, check_step

    with refusals({f"bounds of {parameter}": name}):
        check_range(parameter, bounds)
        check_step(step)
        orbit = (
            approached(system, start) if response_period is None else nearest(system, start, response_period)
        )
        try:
            return Followed(orbit, continue_orbit(orbit, parameter, bounds, step))
        except Refusal as error:
            if error.argument != "orbit":
                raise
            raise Refusal("orbit", error.allowed, error.value, "give another --at") from error


def approached(system: System, start: State) -> Orbit:
    """Return the orbit that the response from the initial state approaches."""
    from rocking.response.classify import classify

    verdict = classify(system, start)
    if verdict.orbit is None:
        raise InvalidInput(
            f"the response from the initial state must be periodic; got {verdict.kind} (give --response-period, "
            "another --at, or another --angle and --velocity)"
        )
    return verdict.orbit


def nearest(system: System, start: State, response_period: int) -> Orbit:
    """Return an orbit near the initial state with the response period wanted; InvalidInput if Newton's method finds none."""
    from rocking.orbits.find_orbit import find_orbit

    period = whole("response_period", response_period, 1, MAX_RESPONSE_PERIOD)
    state = f"--angle {start.angle:.6g} and --velocity {start.velocity:.6g}"
    nearer = "give --angle and --velocity nearer to the orbit"
    try:
        orbit = find_orbit(system, start, period)
    except NoOrbit as error:
        raise InvalidInput(
            f"no orbit of period {period} was found from {state}: Newton's method ends at {error.state}, with a residual of "
            f"{error.residual:.3g} ({nearer}, or another --response-period)"
        ) from error
    except Refusal as error:
        if error.argument != "guess":
            raise
        raise InvalidInput(f"the initial state must {error.allowed}; got {state} ({nearer})") from error
    if orbit.period != period:
        raise InvalidInput(
            f"the orbit found near the initial state must have --response-period {period}; got period {orbit.period} "
            f"({nearer})"
        )
    return orbit


def sweep(options: Options) -> Request:
    """Return the request of an orbit diagram: exactly one option is an axis."""
    varied = varied_of(options, Axis, AXIS_FORM)
    axis = options[varied.name]
    ends: tuple[float, float] = axis.start, axis.stop
    if varied.name in VARIES:  # each SI quantity is proportional to the normalised one
        ends = ends_of(varied)
    arguments = {
        "system": varied.first,
        varied.parameter: np.linspace(*ends, axis.points),
        "start": start_of(options),
        **own_arguments(options),
    }
    return Request(arguments, options, varied.block, varied=varied_text(varied.name, axis))


# The displacement is absent: its amplitude of acceleration would vary with the frequency.
RESPONSE_NEEDS = "--height, --width, --acceleration (or --acceleration-g) and --frequency-hz (or --period-s)"


def frequency_response(options: Options) -> Request:
    """Return the request of a frequency response: the period or the frequency is an axis."""
    if normalised_and_si(options)[1]:
        groups: tuple[tuple[str, ...], ...] = (("height",), ("width",), SI[2:4], SI[5:])
        require(options, groups, RESPONSE_NEEDS)
    else:
        groups = (("amplitude",), ("period", "frequency"), ("restitution",))
        require(options, groups, f"{NORMALISED_NEEDS}, or in SI {RESPONSE_NEEDS}")
    both = {name: value.start if isinstance(value, Axis) else value for name, value in options.items()}
    system_of(both)  # period and frequency together are invalid
    varied = varied_of(options, Axis, AXIS_FORM)
    axis = options[varied.name]
    arguments = {
        "system": varied.first,
        varied.parameter: np.linspace(*ends_of(varied), axis.points),
        "modes": options.get("modes", DEFAULT_MODES),
        "step": options["step"],
        "max_cycles": options["max_cycles"],
        **select(options, "store", "repair"),
    }
    amplitude = next(name for name in AMPLITUDES if name in options)
    names = {varied.parameter: option(varied.name), "amplitude": option(amplitude)}
    text = f"{varied_text(varied.name, axis)} ({axis.points:,} values)"
    return Request(arguments, options, varied.block, names, varied=text)


# Surveys of systems with a harmonic base motion.


def normalised(options: Options) -> dict[str, Any]:
    """Return normalised numbers and arrays of quantities given as numbers, axes and lists."""
    options = select(options, *SYSTEM, *START, *LAWS[:2], "model")
    check_both_sides(options)
    varied = {name: each for name, each in options.items() if isinstance(each, Axis)}
    lists = {name: each for name, each in options.items() if isinstance(each, np.ndarray)}
    if in_si := [name for name in lists if name in SI]:
        raise InvalidInput(f"{option(in_si[0])} with SI input must be a number or {AXIS_FORM}; got a list")
    if "displacement" in options and {"frequency_hz", "period_s"} & varied.keys():
        raise InvalidInput(
            "--displacement with an axis of the frequency varies amplitude and frequency: use --acceleration instead"
        )
    # Valid ranges are intervals, so that two valid ends imply valid values between them.
    first, last = (
        numbers_of(
            options
            | {name: getattr(each, end) for name, each in varied.items()}
            | {name: each[place] for name, each in lists.items()}
        )
        for end, place in (("start", 0), ("stop", -1))
    )
    points = {VARIES.get(name, name): axis.points for name, axis in varied.items()}
    return {
        name: values_of(Axis(first[name], last[name], points[name])) if name in points else first[name]
        for name in SURVEYED
        if name in first
    } | lists


def numbers_of(options: Options) -> dict[str, Any]:
    """Return the quantities of a system and an initial state by their names in `parametric_map`."""
    system, _ = system_of(options)
    start = start_of(options)
    numbers = quantities_of(system) | {"angle": start.angle, "velocity": start.velocity}
    del numbers["period" if "frequency" in options or "frequency_hz" in options else "frequency"]
    return numbers


def values_of(value: Any) -> Any:
    """Return the values of an axis in ascending order; other values unchanged."""
    if not isinstance(value, Axis):
        return value
    low, high = sorted((value.start, value.stop))
    return np.linspace(low, high, value.points)


def block_of(options: Options) -> Block | None:
    """Return the block of SI input, else None; a varying restitution is replaced by its first value."""
    if "height" not in options:
        return None
    restitution = options.get("restitution")
    if isinstance(restitution, Axis | np.ndarray):
        first = restitution.start if isinstance(restitution, Axis) else restitution[0].item()
        options = {**options, "restitution": first}
    with refusals():
        return Block(options["height"], options["width"], restitution_of(options), **standing_of(options))


def check_entry(key: str, name: str, value: Any) -> None:
    """Check an entry of a study file for a survey; ValueError if it is invalid."""
    from rocking.response.classify import MAX_CYCLES, MAX_PERIOD
    from rocking.survey.overturning_amplitude import MAX_PHASES
    from rocking.survey.random_points import MAX_SAMPLES, MAX_SEED
    from rocking.survey.spec import number_or_axis
    from rocking.survey.uncertainty_exponent import WIDTHS

    counts = {
        "samples": (1, MAX_SAMPLES),
        "seed": (0, MAX_SEED),
        "phases": (1, MAX_PHASES),
        "max_cycles": (1, MAX_CYCLES),
        "max_period": (1, MAX_PERIOD),
        "boundary_runs": (0, MAX_SAMPLES),
    }
    if name in SURVEYED:
        for each in value[:2] if isinstance(value, tuple) else (value,):
            number_or_axis(key, each, SYSTEM_QUANTITIES[name].range)
    elif name in counts:
        whole(key, value, *counts[name])
    elif name == "boundary_width":
        within(key, value, *WIDTHS)


def survey_request(
    options: Options, arguments: dict[str, Any], names: Mapping[str, str] | None = None
) -> Request:
    """Return the request of a survey; messages name quantities derived from a block in words, as they are no options."""
    block = block_of(options)
    names = {} if block is None else {name: f"the normalised {name}" for name in NORMALISED}
    if block is not None and block.has_housner_restitution:
        names["restitution"] = "restitution, which follows from the block,"
    return Request(own_arguments(options) | arguments, options, block, names)


def of_system(values: Mapping[str, Any], options: Options) -> dict[str, Any]:
    """Return the arguments of a survey of a system: the system, and the axes; the system has the first value of each."""
    axes = {name: value for name, value in values.items() if isinstance(value, np.ndarray)}
    first = dict(values) | {name: value[0].item() for name, value in axes.items()}
    system, block = system_with({"phase": 0.0, **NO_BRACES} | first), block_of(options)
    if block is not None and block.law.rows:
        rows = block.law.normalised_rows(float(block.radians_per_second(1.0)))
        system = evolve(system, restitution_table=rows)
    return {"system": system} | axes


def parametric_map(options: Options) -> Request:
    """Return the request of a parametric map."""
    values = normalised(options)
    fixed = {name: value for name, value in values.items() if not isinstance(value, np.ndarray)}
    start = State(**select(fixed, *START))
    request = survey_request(options, of_system(values, options) | {"start": start})
    drawn = [name for name in ("curves", "symbols") if name in options]
    if drawn and "plot" not in options:
        raise InvalidInput(f"{option(drawn[0])} needs a plot: give --plot FILE as well")
    if drawn:
        from rocking.plot import style, theory_curves
        from rocking.survey.spec import harmonic_spec

        with refusals(request.names):
            axes = select(request.arguments, *SURVEYED)
            spec = harmonic_spec(fixed, axes, 2, "a parametric map")
            style.check_symbols(options.get("symbols"))
            theory_curves.check(options.get("curves", ()), spec.axes, spec.fixed)
    return request


def basins(options: Options) -> Request:
    """Return the request of basins of attraction."""
    system, _ = system_of(options)
    reach = 1.0 if system.braces is None else min(system.braces.angle, 1.0)
    axes = {"angle": Axis(-reach, reach, STARTS), "velocity": Axis(-1.0, 1.0, STARTS)} | select(
        options, *START
    )
    random = "samples" in options
    starts = {
        name: [axis.start, axis.stop] if random and isinstance(axis, Axis) else values_of(axis)
        for name, axis in axes.items()
    }
    return survey_request(options, {"system": system} | starts)


def safe_basin(options: Options) -> Request:
    """Return the request of a safe basin."""
    numbers = normalised({name: value for name, value in options.items() if name not in START})
    reach = min(numbers.get("brace_angle", 1.0), 1.0)
    starts = {"angle": (-reach, reach)} | select(options, *START)
    return survey_request(options, of_system(numbers, options) | select(numbers, "amplitude") | starts)


def overturning(options: Options) -> Request:
    """Return the request of the lowest overturning amplitudes."""
    in_si = bool(normalised_and_si(options)[1])
    if in_si:
        require(
            options, (("height",), ("width",), SI[5:]), "--height, --width and --frequency-hz (or --period-s)"
        )
    else:
        needs = "--period (or --frequency) and --restitution"
        require(options, (("period", "frequency"), ("restitution",)), needs)
    varied = [
        name
        for name, each in options.items()
        if name in SYSTEM and name not in AMPLITUDES and not isinstance(each, int | float)
    ]
    if "plot" in options and len(varied) > 1:
        raise InvalidInput(
            f"--plot needs a single axis; got {' and '.join(map(option, varied))} (give one of them as a number)"
        )
    scanned = any(name in options for name in AMPLITUDES)
    ignored = {} if scanned else {"acceleration" if in_si else "amplitude": 0.0}
    return survey_request(options, of_system(normalised({**options, **ignored}), options))


def overturning_spectrum(options: Options) -> Request:
    """Return the request of an overturning spectrum of pulses."""
    require(options, (("pulse",),), "the form of the pulse, such as --pulse one-sine")
    if normalised_and_si(options)[1]:
        options = {**options, "model": model_of(options)}
        needs = "--height, --width, --acceleration (or --acceleration-g) and --frequency-hz"
        require(options, (("height",), ("width",), SI[2:4], SI[5:6]), needs)
        if "acceleration" in options and "acceleration_g" in options:
            raise InvalidInput("give --acceleration or --acceleration-g, not both")
    else:
        require(
            options,
            (("amplitude",), ("frequency",), ("restitution",)),
            "--amplitude, --frequency and --restitution",
        )
        if "normalised_by" in options:
            raise InvalidInput(NO_UNIT)
    for name in ("restitution", "critical_angle"):
        if "plot" in options and not isinstance(options.get(name, 0.0), int | float):
            raise InvalidInput(f"--plot needs one value of {option(name)}; got an axis (give a number)")
    numbers = normalised({name: value for name, value in options.items() if name != "pulse"})
    axes = {name: value for name, value in numbers.items() if isinstance(value, np.ndarray)}
    own = {name: value.item(0) if name in axes else value for name, value in numbers.items()}
    with refusals({"kind": "--pulse"}):
        pulse, block = Pulse(options["pulse"], amplitude=1.0, duration=1.0), block_of(options)
        if block is None:
            system = System(pulse, own["restitution"], critical_angle=own.get("critical_angle"))
        else:
            system = block.system(pulse, **select(options, "model", "normalised_by"))
    if "amplitude" in axes:
        axes["amplitude"] = axes["amplitude"] * unit_ratio(system.block)
    if "frequency" in axes and system.block is not None:
        axes["frequency"] = axes["frequency"] * (system.block.frequency_parameter / system.block.rate_unit)
    return evolve(survey_request(options, {"system": system} | axes), block=system.block)
