"""Study files: options of a command in TOML; all errors of a file are reported together."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input.axis import DEFAULT_COUNT, MAX_POINTS, Axis, number_or_axis
from rocking.cli.option_names import AXIS_FORM, YourInput

STUDY = (
    'Read options from a TOML file, for example restitution = 0.9 or period = "1:3:60". '
    "Options on the command line take precedence."
)
Study = Annotated[Path | None, typer.Option("--study", metavar="FILE", help=STUDY)]
MAX_BYTES = 1_000_000
"""Maximum size of a study file; a typical one has ten lines."""
Check = Callable[[Any], Any]


def quantity(name: str, given: Any) -> Any:
    """Return an entry as a number, an `Axis` or a list of values.

    The entry is a number, a text as on the command line, a table of start, stop and count, or a list.
    """
    from rocking.model import reals, whole

    if isinstance(given, str):
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
    start, stop = (float(reals(f"{part} of {name}", given[part])) for part in ("start", "stop"))
    return Axis(start, stop, whole(f"count of {name}", given.get("count", DEFAULT_COUNT), 2, MAX_POINTS))


def number(name: str, given: Any) -> Any:
    """Return an entry that is a number."""
    from rocking.model import reals, refusal

    if isinstance(given, bool) or not isinstance(given, int | float):
        raise TypeError(refusal(name, "be a number", given))
    reals(name, given)
    return given


def numbers(*names: str) -> dict[str, Check]:
    """Return the checks of entries that are numbers; the function that gets them checks their ranges."""
    return {name: partial(number, name) for name in names}


def model(given: Any) -> Any:
    """Return the name of an equation of motion."""
    from rocking.model import MODELS, one_of

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
    import tomllib

    try:
        said = tomllib.loads(_text(path))
    except (OSError, ValueError, RecursionError) as error:
        why = getattr(error, "strerror", None) or error
        if isinstance(error, RecursionError):
            why = "the file is nested too deeply"
        raise YourInput(f"--study must name a TOML file; got {str(path)!r}: {why}") from error
    _check_once(path, said)
    given = {key.replace("-", "_"): entry for key, entry in said.items()}
    found: dict[str, Any] = {}
    errors: list[str] = []
    for name in filter(given.__contains__, checks):
        try:
            found[name] = checks[name](given[name])
        except (TypeError, ValueError) as error:
            errors.append(str(error))
    errors += [_unknown(name, checks) for name in sorted(given.keys() - checks.keys())]
    if errors:
        raise YourInput(f"study {str(path)!r}: " + "; ".join(errors))
    return found


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
    twice = [key for key in said if "-" in key and key.replace("-", "_") in said]
    if twice:
        raise YourInput(
            f"study {str(path)!r}: {twice[0]!r} occurs twice, with hyphens and with underscores (remove one)"
        )


def _unknown(name: str, checks: Mapping[str, Check]) -> str:
    """Return the message for an unknown key, with the most similar known one."""
    close = difflib.get_close_matches(name, checks, 1)
    meant = f"did you mean {close[0]!r}?" if close else "keys are the names of options of this command"
    return f"unknown {name!r} ({meant})"
