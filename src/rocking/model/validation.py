"""Validation of arguments, with one-line messages: the argument, the allowed values, the given value and the remedy.

Also messages for keywords that a function does not have, and warnings of input that is probably not what the user means.
"""

from __future__ import annotations

import difflib
import inspect
import math
import re
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping, MutableMapping, Sequence
from functools import wraps
from numbers import Real
from types import FrameType
from typing import Any, TypeVar, cast

import numpy as np

from rocking.model.text import formatted

Value = TypeVar("Value")

MAX_REAL = 1e300
"""Largest size of a finite number in an array: a conversion of units does not overflow."""
REMEDIES = {
    "State": "make one: rk.State(angle=0.1, velocity=0.0)",
    "Harmonic": "make one: rk.Harmonic(amplitude=2.0, period=1.0)",
    "Braces": "make one: rk.Braces(angle=1.0)",
    "Block": "make one: rk.Block(height=2.0, width=0.5)",
    "LeftSide": "make one: rk.LeftSide(angle_ratio=1.4, frequency_ratio=0.99, restitution=0.9)",
    "Wall": "make one: rk.Wall(restitution=0.5)",
    "System": "make one: rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925), or by rk.Block: "
    "block.system(rk.read_ground_motion(path))",
    "BaseMotion": "read a record by rk.read_ground_motion(path), or make an rk.GroundMotion or rk.Pulse",
    "Orbit": "rk.classify returns one only if the response is periodic; rk.find_orbits searches for all",
    "Block for System": "make one: block.system(acceleration=3.0, frequency_hz=1.2)",
    "Harmonic for System": "make one: rk.System(forcing, restitution=0.925)",
    "Pulse for System": "make one: rk.System(pulse, restitution=0.925), or block.system(pulse) in SI units",
    "GroundMotion for System": "make one: rk.Block(height=2.0, width=0.5).system(ground_motion)",
}
"""Remedies for an argument that is missing or of the wrong type, by type, also by what was given for what."""


class TooManyEvents(ValueError):
    """Simulation with more events than can be recorded. The message states how to reduce them.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> try:
    ...     print(rk.simulate(system, cycles=100).outcome)
    ... except rk.TooManyEvents:
    ...     print("run fewer cycles")
    bounded
    """


class ContactLost(ValueError):
    """Motion under vertical acceleration in which the block leaves the base: its weight or the base reaction vanishes.

    The message states the instant.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(height=2.0, width=0.6)
    >>> ground = rk.GroundMotion([0.0, 4.0, 0.0], step=0.5)
    >>> down = rk.GroundMotion([0.0, -12.0, 0.0], step=0.5)
    >>> try:
    ...     print(rk.simulate(block.system(ground, vertical=down)))
    ... except rk.ContactLost as lost:
    ...     print(lost)
    the weight vanishes at t = 0.408610 s: the block leaves the base
    """


class TooShort(ValueError):
    """Motion that is too short for an estimate with an error.

    Attributes
    ----------
    estimate : object
        Result as far as the data support it, usually without a finite error.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), restitution=0.925, braces=rk.Braces(1.0))
    >>> section = rk.simulate(system, cycles=1000, record="section").section()
    >>> try:
    ...     _ = rk.correlation_dimension(section)
    ... except rk.TooShort as error:
    ...     print(type(error.estimate).__name__)
    CorrelationDimension
    """

    def __init__(self, message: str, estimate: Any) -> None:
        super().__init__(message)
        self.estimate = estimate

    def __reduce__(self) -> tuple[Any, ...]:
        # An exception is unpickled from its message alone unless this is defined.
        return type(self), (str(self), self.estimate), self.__dict__


class NoOrbit(ValueError):
    """Search that found no periodic orbit.

    Attributes
    ----------
    phase : float
        Forcing phase of the section, rad.
    state : State
        Last state of the search on this section.
    residual : float
        Distance between this state and the state one period later.

    Examples
    --------
    >>> import rocking as rk
    >>> error = rk.NoOrbit("no orbit", phase=0.0, state=rk.State(angle=0.1), residual=0.5)
    >>> error.residual
    0.5
    """

    def __init__(self, message: str, phase: float, state: Any, residual: float) -> None:
        super().__init__(message)
        self.phase = phase
        self.state = state
        self.residual = residual

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.phase, self.state, self.residual), self.__dict__


class RecordError(ValueError):
    """Record file that cannot be read. The message is one line and names the file and the place.

    Attributes
    ----------
    argument : str
        "units" or "step" if the file lacks what this argument gives, or if it states it itself; empty for any other error.

    Examples
    --------
    >>> import rocking as rk
    >>> str(rk.RecordError("a.at2, line 4: no step"))
    'a.at2, line 4: no step'
    """

    def __init__(self, message: str, argument: str = "") -> None:
        super().__init__(message)
        self.argument = argument


class Text(str):
    """Text that messages print as it is, without quotation marks."""

    __slots__ = ()
    __repr__ = str.__str__


NO_VALUE = Text()
NAME = re.compile(r"{([a-z_][a-z_0-9]*)}")
"""Name of an argument in a text."""


class Refusal(ValueError):
    """Invalid argument: "argument must be what is allowed; got value (remedy)".

    The texts may name further arguments, each in braces, such as "{period}". They are printed without the braces.

    Parameters
    ----------
    argument : str
        Name of the argument, or a phrase that names arguments in braces.
    allowed : str
        What the value must be, beginning with a verb: "be a real number", "lie in [0, 1]".
    value : object, optional
        Invalid value. Default: none is printed. In a pickled copy it is the text that is printed.
    remedy : str
        What to do, printed in parentheses. Default: "".

    Attributes
    ----------
    argument, allowed, value, remedy
        As above.

    Examples
    --------
    >>> error = Refusal("restitution", "lie in [0, 1]", 1.2)
    >>> print(error)
    restitution must lie in [0, 1]; got 1.2
    >>> print(error.of({"restitution": "--restitution"}))
    --restitution must lie in [0, 1]; got 1.2
    """

    def __init__(self, argument: str, allowed: str, value: object = NO_VALUE, remedy: str = "") -> None:
        super().__init__(argument, allowed, value, remedy)
        self.argument = argument
        self.allowed = allowed
        self.value = value
        self.remedy = remedy
        self._names: dict[str, str] = {}

    def of(self, names: Mapping[str, str]) -> Refusal:
        """Return the same refusal with the names of arguments that a user typed, such as ``{"period": "--period"}``."""
        other = type(self)(self.argument, self.allowed, self.value, self.remedy)
        other._names = {**self._names, **names}
        return other

    def __str__(self) -> str:
        argument = self._names.get(self.argument, self.argument)
        value, remedy = formatted(self.value), self._named(self.remedy)
        if isinstance(self.value, Text):
            value = self._named(self.value)
        parts = (
            self._named(self._sentence(argument)),
            f"; got {value}" * bool(value),
            f" ({remedy})" * bool(remedy),
        )
        return "".join(parts)

    def _sentence(self, argument: str) -> str:
        return f"{argument} must {self.allowed}"

    def _named(self, text: str) -> str:
        return NAME.sub(lambda name: self._names.get(name[1], name[1]), text)

    def __reduce__(self) -> tuple[Any, ...]:
        # The value may be anything, such as a function that another process cannot have.
        state = self.__dict__ | {"value": Text(formatted(self.value))}
        return type(self), (self.argument, self.allowed, state["value"], self.remedy), state


class Statement(Refusal):
    """Refusal in a sentence of its own: "store a.zarr holds a different survey"; `argument` is a noun phrase."""

    def _sentence(self, argument: str) -> str:
        return f"{argument} {self.allowed}"


class WrongType(Refusal, TypeError):
    """Argument of a type that is not allowed."""


class NotOne(WrongType):
    """None or several of arguments of which exactly one is needed; `argument` names them all, each in braces."""

    def _sentence(self, argument: str) -> str:
        return f"give exactly one of {argument}"


class Incomplete(WrongType):
    """Call that lacks arguments: "what is called needs what is missing"; `argument` is a noun phrase."""

    def _sentence(self, argument: str) -> str:
        return f"{argument} needs {self.allowed}"


def refusal(name: str, allowed: str, value: object, remedy: str = "") -> str:
    """Return the message for an invalid value, in the form used by the whole package."""
    return str(Refusal(name, allowed, value, remedy))


def refuse_if(wrong: object, name: str, allowed: str, value: object, remedy: str = "") -> None:
    """Refuse the value of an argument with a sentence, where something is wrong with it."""
    if wrong:
        raise Refusal(name, allowed, value, remedy)


def within(name: str, value: float, low: float, high: float, unit: str = "", if_below: str = "") -> float:
    """Return `value` as a float in [low, high].

    Parameters
    ----------
    name : str
        Name of the argument, for messages.
    value : float
        Value to check. NaN and infinities are rejected.
    low, high : float
        Range.
    unit : str
        Unit, for messages. Default: "".
    if_below : str
        Remedy for a value below the range. Default: "".

    Raises
    ------
    TypeError
        If `value` is not a real number (a bool, a string, a complex number, an array, None).
    ValueError
        If `value` lies outside the range.

    Examples
    --------
    >>> within("restitution", 1, 0, 1)
    1.0
    >>> within("restitution", 1.2, 0, 1)
    Traceback (most recent call last):
    rocking.model.validation.Refusal: restitution must lie in [0, 1]; got 1.2
    """
    interval = f"[{low:.6g}, {high:.6g}]" + (f" {unit}" if unit else "")
    number = real(name, value, f"be a real number in {interval}")
    if not low <= number <= high:
        raise Refusal(name, f"lie in {interval}", value, if_below if number < low else "")
    return number


def finite(name: str, value: float, largest: float) -> float:
    """Return `value` as a float of size up to `largest`, a bound above all sensible values; errors as in `within`."""
    if type(value) is float and abs(value) <= largest:
        return value
    allowed = f"be a finite real number of size up to {largest:g}"
    number = real(name, value, allowed)
    if not abs(number) <= largest:
        raise Refusal(name, allowed, value)
    return number


def number(value: object) -> Any:
    """Return the real number that a value is, or that an array of shape () holds; None, also for shape (1,)."""
    if type(value) is float:
        return value
    if getattr(value, "shape", None) == () and not np.ma.is_masked(value):
        value = np.asarray(value)[()]
    return value if isinstance(value, Real) and not isinstance(value, bool | np.timedelta64) else None


def real(name: str, value: float, allowed: str = "be a real number") -> float:
    """Return a real number as a float, infinite on overflow; TypeError for other types."""
    real_number = number(value)
    if real_number is None:
        raise WrongType(name, allowed, value)
    try:
        return float(real_number)
    except OverflowError:
        return math.inf if real_number > 0 else -math.inf


def whole(name: str, value: int, low: int, high: int) -> int:
    """Return `value` as an int in [low, high]; a float is accepted if it is whole (1e6).

    Raises
    ------
    TypeError
        If `value` is not a real number.
    ValueError
        If `value` lies outside the range or has a fraction.
    """
    allowed = f"be a whole number in [{low}, {high}]"
    real_number = number(value)
    if real_number is None:
        raise WrongType(name, allowed, value)
    if not low <= real_number <= high or real_number != int(real_number):
        raise Refusal(name, allowed, value)
    return int(real_number)


def reals(name: str, values: Any, largest: float | None = None) -> Any:
    """Return a real number as a float, and anything array-like as an array of floats.

    Parameters
    ----------
    name : str
        Name of the argument, for messages.
    values : float or array_like
        Values to check.
    largest : float, optional
        Bound of the size of all values, which excludes NaN. Default: 1e300, where NaN and infinities are allowed.

    Raises
    ------
    TypeError
        If `values` holds anything but real numbers.
    ValueError
        If a number is too large, or if values are masked.
    """
    numbers = number(values)
    if numbers is None:
        numbers = _array(name, values)
    size = abs(numbers)
    wrong = (size > MAX_REAL) & (size != math.inf) if largest is None else np.logical_not(size <= largest)
    if np.any(wrong):
        first = numbers[wrong].flat[0] if isinstance(numbers, np.ndarray) else values
        finite_only = "" if largest is None else "finite "
        raise Refusal(name, f"be a {finite_only}real number of size up to {largest or MAX_REAL:g}", first)
    return numbers if isinstance(numbers, np.ndarray) else float(numbers)


def _array(name: str, values: Any) -> np.ndarray:
    """Return anything array-like as an array of floats; errors as in `reals`."""
    if _is_masked(values):
        raise Refusal(name, "hold no masked values", values, "leave them out, or fill them")
    try:
        array = np.asarray(values)
    except (TypeError, ValueError, RecursionError, MemoryError):
        array = np.asarray(None)
    if array.dtype.kind not in "fiu":
        raise WrongType(name, "be a real number or an array of real numbers", values)
    return array.astype(float)


def _is_masked(values: Any) -> bool:
    """Return whether a value is masked in an array, or in a list of arrays at any depth."""
    waiting, seen = [values], set()
    while waiting:
        result = waiting.pop()
        if isinstance(result, list | tuple) and id(result) not in seen:
            seen.add(id(result))  # a list may contain itself
            waiting += result
        elif isinstance(result, np.ma.MaskedArray) and np.ma.is_masked(result):
            return True
    return False


def members(name: str, values: Any, allowed: str) -> tuple[Any, ...]:
    """Return the members of a sequence; TypeError, with `allowed` in its message, for text, mappings and scalars."""
    if isinstance(values, str | bytes | Mapping) or not isinstance(values, Iterable):
        raise WrongType(name, allowed, values)
    try:
        return tuple(values)
    except TypeError:  # an array without dimensions
        raise WrongType(name, allowed, values) from None


def pair(name: str, values: Any, allowed: str) -> tuple[Any, Any]:
    """Return both members of a pair; TypeError or ValueError, with `allowed` in its message, for anything else."""
    result = members(name, values, allowed)
    if len(result) != 2:
        raise Refusal(name, allowed, values)
    return result[0], result[1]


def instance(name: str, value: Value, kind: type) -> Value:
    """Return `value` if it is an instance of `kind`; TypeError for anything else."""
    if not isinstance(value, kind):
        article = "an" if kind.__name__[0] in "AEIO" else "a"
        remedy = REMEDIES.get(f"{type(value).__name__} for {kind.__name__}") or REMEDIES.get(
            kind.__name__, ""
        )
        raise WrongType(name, f"be {article} {kind.__name__}", value, remedy)
    return value


def one_of(name: str, value: str, allowed: Sequence[str]) -> str:
    """Return `value` if it is one of the `allowed` words; TypeError or ValueError for anything else."""
    choices = f"be one of {', '.join(map(repr, allowed))}"
    if not isinstance(value, str):
        raise WrongType(name, choices, value)
    if value not in allowed:
        raise Refusal(name, choices, value)
    return value


def exactly_one(**values: object) -> str:
    """Return the name of the only one of `values` that is not None; TypeError if there is not exactly one.

    Examples
    --------
    >>> exactly_one(period=1.0, frequency=None)
    'period'
    >>> exactly_one(period=None, frequency=None)
    Traceback (most recent call last):
    rocking.model.validation.NotOne: give exactly one of period, frequency; got none
    """
    arguments = {name: value for name, value in values.items() if value is not None}
    if len(arguments) != 1:
        got = " and ".join(f"{{{name}}}={formatted(value)}" for name, value in arguments.items()) or "none"
        names = ", ".join(f"{{{name}}}" for name in values)
        raise NotOne(names, "be one", Text(got))
    return next(iter(arguments))


Call = TypeVar("Call", bound=Callable[..., Any])
MAX_LISTED = 180


def similar(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that is most similar to an unknown one: the shortest that begins with it, or a near one, or None.

    Examples
    --------
    >>> similar("restituion", ["forcing", "restitution"]), similar("h", ["height", "width"]), similar("t_end", ["cycles"])
    ('restitution', 'height', None)
    """
    known = sorted(known, key=len)
    begun = [each for each in known if each.startswith(name)]
    return next(iter(begun + difflib.get_close_matches(name, known, 1, cutoff=0.8)), None)


def explain(namespace: MutableMapping[str, Any], names: Iterable[str]) -> None:
    """Let the public functions and classes in a namespace explain calls that do not fit their signature.

    A function is replaced in this namespace, and pickled by its name there. A class gets another constructor. Signatures and
    docstrings stay the same.
    """
    for name in names:
        value = namespace[name]
        if inspect.isfunction(value):
            namespace[name] = explained(value)
            namespace[name].__module__ = namespace["__name__"]
        elif inspect.isclass(value) and "__init__" in vars(value):
            value.__init__ = explained(value.__init__)  # type: ignore[method-assign]


RENAMED = {
    ("rocking_spectrum", "scale"): "levels",
    ("overturning_set", "scales"): "levels",
    ("overturning_spectrum", "kind"): "system, with an rk.Pulse of that kind",
    ("proved_share", "found"): "result",
    **{
        (function, old): "the quantity by its name, such as amplitude=values"
        for function in ("orbit_diagram", "response_diagram")
        for old in ("parameter", "values")
    },
}
"""Arguments of version 0.1 that have another name, by function: what replaces them."""


OF_LEFT = ("angle_ratio", "frequency_ratio", "left_restitution")
OF_LEFT_REMEDY = "it is a quantity of the left side, System(…, left=rk.LeftSide(…)), and is no axis here"


def explained(function: Call) -> Call:
    """Return the function with messages for a call that does not fit its signature.

    They state what replaces an unknown keyword, how to make a missing argument, and which arguments need a name.
    """
    if hasattr(function, "__wrapped__"):
        return function

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            if error.__traceback__.tb_next is not None:  # type: ignore[union-attr]
                raise  # the call itself was right
            message = _of_call(function, args, kwargs)
            if not message:
                raise
            raise TypeError(message) from None

    return cast(Call, call)


def _of_call(function: Callable[..., Any], args: Sequence[Any], kwargs: Mapping[str, Any]) -> str:
    """Return the message for a call that does not fit the signature of a function; "" if that of Python says all."""
    name = function.__qualname__.removesuffix(".__init__").rpartition(".")[-1]
    parameters = inspect.signature(function).parameters
    by_position = [each for each in parameters.values() if each.kind is each.POSITIONAL_OR_KEYWORD]
    if len(args) > len(by_position):
        return _too_many(name, args, [each.name for each in by_position], parameters)
    any_keyword = any(each.kind is each.VAR_KEYWORD for each in parameters.values())
    unknown = next((key for key in kwargs if key not in parameters and not any_keyword), None)
    near = unknown and _near(name, unknown, [key for key in parameters if key != "self"])
    if not near:
        for each in by_position[len(args) :]:
            if each.default is each.empty and each.name not in kwargs and each.annotation in REMEDIES:
                return f"{name}() needs {each.name} ({REMEDIES[each.annotation]})"
    if unknown is None:
        return ""
    return f"{name}() has no argument {formatted(unknown)} ({near or _listed(parameters)})"


def _near(function: str, unknown: str, known: list[str]) -> str:
    """Return what replaces an unknown keyword of a function, or the most similar one; "" if there is none."""
    if unknown in OF_LEFT:
        return OF_LEFT_REMEDY
    if (function, unknown) in RENAMED:
        return f"since version 0.2 it is {RENAMED[function, unknown]}"
    near = similar(unknown, known)
    return f"did you mean {near!r}?" if near else ""


def _listed(parameters: Iterable[str]) -> str:
    """Return the arguments of a function as a remedy; the last ones are left out if there are many."""
    text = ", ".join(name for name in parameters if name != "self")
    if len(text) > MAX_LISTED:
        text = text[:MAX_LISTED].rpartition(", ")[0] + ", …"
    return f"it has: {text}" if text else "it has none"


def _too_many(name: str, args: Sequence[Any], by_position: list[str], parameters: Iterable[str]) -> str:
    """Return the message for arguments without a name that need one; "" if there is no argument that needs one."""
    named = [each for each in parameters if each not in by_position]
    typed = [each for each in args if isinstance(each, str) and each in named]
    if not named:
        return ""
    first = ", ".join(each for each in by_position if each != "self") or "none"
    return f"{name}() takes these arguments without a name: {first} (give the others by name, such as {(typed or named)[0]}=…)"


OWN = ("rocking", "attr", "attrs", "contextlib")


class InputWarning(UserWarning):
    """Input that is allowed, but probably not what is meant: a wrong unit, a vertical channel, a peak unlike that of the header.

    The message is one sentence. All warnings of the package have this class. `warnings.simplefilter("error", rk.InputWarning)`
    makes errors of them.

    Examples
    --------
    >>> import rocking as rk
    >>> issubclass(rk.InputWarning, UserWarning)
    True
    """


def warn_of_input(sentence: str) -> None:
    """Warn the user, whose line is the first one outside the package."""
    frame: FrameType | None = sys._getframe(1)
    level = 2
    while frame is not None and _is_own(frame):
        frame, level = frame.f_back, level + 1
    warnings.warn(sentence, InputWarning, stacklevel=level)


def warn_of_value(sentence: str) -> None:
    """Warn of an argument of the calling method or class; the package, which gives such values on purpose, is not warned."""
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and (_is_generated(frame) or frame.f_globals.get("__name__") == __name__):
        frame = frame.f_back
    if frame is not None and not _is_own(frame):
        warn_of_input(sentence)


def _is_generated(frame: FrameType) -> bool:
    return frame.f_code.co_filename.startswith("<attrs generated")


def _is_own(frame: FrameType) -> bool:
    return _is_generated(frame) or str(frame.f_globals.get("__name__")).partition(".")[0] in OWN
