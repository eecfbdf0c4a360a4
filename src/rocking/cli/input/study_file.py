"""Study files: options of a command in TOML; all errors of a file are reported together."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input.axis import DEFAULT_COUNT, MAX_POINTS, Axis, Range, number_or_axis
from rocking.cli.option_names import AXIS_FORM, RANGE_FORM, YourInput, as_typed

STUDY = (
    'Read options from a TOML file, for example restitution = 0.9 or period = "1:3:60". '
    "Options on the command line take precedence."
)
Study = Annotated[Path | None, typer.Option("--study", metavar="FILE", help=STUDY)]
UNQUOTED = "write a number without quotation marks"
MAX_BYTES = 1_000_000
"""Maximum size of a study file; a typical one has ten lines."""
Check = Callable[[Any], Any]


def quantity(name: str, given: Any) -> Any:
    """Return an entry as a number, an `Axis` or a list of values.

    The entry is a number, an axis in a text as on the command line, a table of start, stop and count, or a list.
    """
    from rocking.model.validation import reals, whole

    if isinstance(given, str):
        check_unquoted(name, given, f"be a number or {AXIS_FORM}")
        try:
            return number_or_axis(given)
        except typer.BadParameter as error:
            raise ValueError(f"{name} {error.message}") from None
    if not isinstance(given, Mapping):
        return reals(name, given)
    if not {"start", "stop"} <= given.keys() <= {"start", "stop", "count"}:
        raise ValueError(
            f"{name} must be a number, {AXIS_FORM}, or a table of start, stop and optionally count; "
            f"got {', '.join(given) or 'an empty table'}"
        )
    count = whole(f"count of {name}", given.get("count", DEFAULT_COUNT), 2, MAX_POINTS)
    return Axis(*_ends(name, given), count)


def span(name: str, given: Mapping[str, Any]) -> Range:
    """Return an entry that is a table of start and stop as a range."""
    if given.keys() != {"start", "stop"}:
        raise ValueError(
            f"{name} must be {RANGE_FORM}, or a table of start and stop; got {', '.join(given) or 'an empty table'}"
        )
    return Range(*_ends(name, given))


def _ends(name: str, given: Mapping[str, Any]) -> tuple[float, float]:
    """Return the ends of an axis or a range from a table; they are finite and differ, as those of a text."""
    start, stop = (float(number(f"{part} of {name}", given[part])) for part in ("start", "stop"))
    if start == stop:
        raise ValueError(f"start and stop of {name} must differ; got {start:g} for both")
    return start, stop


def check_unquoted(name: str, given: str, allowed: str) -> None:
    """Raise TypeError for a number in quotation marks; `allowed` states what the entry must be."""
    from rocking.cli.input.options import number as number_of
    from rocking.model.validation import refusal

    with suppress(typer.BadParameter):
        number_of(given)
        raise TypeError(refusal(name, allowed, given, UNQUOTED))


def number(name: str, given: Any) -> Any:
    """Return an entry that is a finite number; TOML also has nan and inf."""
    from rocking.model.validation import reals, refusal

    if isinstance(given, str):
        check_unquoted(name, given, "be a number")
    if isinstance(given, bool) or not isinstance(given, int | float):
        raise TypeError(refusal(name, "be a number", given))
    if not math.isfinite(reals(name, given)):
        raise ValueError(refusal(name, "be a finite number", given))
    return given


def numbers(*names: str) -> dict[str, Check]:
    """Return the checks of entries that are numbers; the function that gets them checks their ranges."""
    return {name: partial(number, name) for name in names}


def model(given: Any) -> Any:
    """Return the name of an equation of motion."""
    from rocking.model.system import MODELS
    from rocking.model.validation import one_of

    return one_of("model", given, MODELS)


def asked(typed: Mapping[str, Any], file: Path | None, checks: Mapping[str, Check]) -> dict[str, Any]:
    """Return the values given by options and by a study file; options take precedence."""
    given = {} if file is None else read(file, checks)
    return given | {
        name: typed[name] for name in checks if typed[name] is not None and typed[name] is not False
    }


def read(path: Path, checks: Mapping[str, Check]) -> dict[str, Any]:
    """Return the entries of a study file as returned by their checks; YourInput with all errors of the file.

    Keys are the names of options, with hyphens or underscores.
    """
    from rocking.model.text import shown_path
    from rocking.model.validation import similar

    said = _entries(path)
    _check_once(path, said)
    keys = {key.replace("-", "_"): key for key in said}
    found: dict[str, Any] = {}
    errors: list[str] = []
    for name in filter(keys.__contains__, checks):
        try:
            found[name] = checks[name](said[keys[name]])
        except (TypeError, ValueError) as error:
            errors.append(as_typed(str(error), {name: keys[name]}))
    unknown = sorted(keys.keys() - checks.keys())
    errors += [_unknown(keys[name], said[keys[name]], checks) for name in unknown]
    if any(similar(name, checks) is None and not _is_section(said[keys[name]]) for name in unknown):
        errors.append("keys of this command: " + ", ".join(name.replace("_", "-") for name in checks))
    if errors:
        raise YourInput(f"study {shown_path(path)}: " + "; ".join(errors))
    return found


def _entries(path: Path) -> dict[str, Any]:
    """Return the keys and values of a study file; YourInput if it cannot be read."""
    import tomllib

    from rocking.model.text import shown_path

    try:
        return tomllib.loads(_text(path))
    except (OSError, ValueError, RecursionError) as error:
        why = getattr(error, "strerror", None) or error
        if isinstance(error, RecursionError):
            why = "the file is nested too deeply"
        elif isinstance(error, UnicodeDecodeError):
            why = "the file is not text in UTF-8"
        raise YourInput(f"--study must name a TOML file; got {shown_path(path)}: {why}") from error


def with_keys(message: str, path: Path, typed: Collection[str]) -> str:
    """Return a message with the keys of a study file that give the options named in it, except options `typed` as well."""
    from rocking.model.text import shown_path

    given = [key for key in _entries(path) if key.replace("-", "_") not in typed]
    named = [
        key
        for key in given
        if re.search(rf"(?<![\w-])--?{re.escape(key.replace('_', '-'))}(?![\w-])", message)
    ]
    return f"{message} (study {shown_path(path)} gives {', '.join(named)})" if named else message


def _text(path: Path) -> str:
    """Return the text of a regular file of limited size: reading a device or a pipe may never end."""
    if path.exists() and not path.is_file() and not path.is_dir():
        raise ValueError("not a regular file but a device, a pipe or a socket")
    with path.open("rb") as file:
        content = file.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise ValueError(f"the file has more than {MAX_BYTES:,} bytes")
    return content.decode("utf-8-sig")


def _check_once(path: Path, said: Mapping[str, Any]) -> None:
    """Raise YourInput for a key that occurs with hyphens and with underscores."""
    from rocking.model.text import shown_path

    twice = [key for key in said if "-" in key and key.replace("-", "_") in said]
    if twice:
        raise YourInput(
            f"study {shown_path(path)}: {twice[0]!r} occurs twice, with hyphens and with underscores (remove one)"
        )


def _unknown(key: str, entry: Any, checks: Mapping[str, Check]) -> str:
    """Return the message for an unknown key as written in the file, with a known one if it is similar."""
    if _is_section(entry):
        return f"unknown {key!r} (a section: write the keys of options without sections)"
    from rocking.model.validation import similar

    near = similar(key.replace("-", "_"), checks)
    if near is None:
        return f"unknown {key!r}"
    return f"unknown {key!r} (did you mean {near if '_' in key else near.replace('_', '-')!r}?)"


def _is_section(entry: Any) -> bool:
    """Return whether an entry is a table other than an axis or a range."""
    return isinstance(entry, Mapping) and not {"start", "stop"} & entry.keys()
