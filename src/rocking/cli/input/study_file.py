"""Study files: the options of a command in TOML, all errors of a file told at once."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input.axis import DEFAULT_COUNT, FORM, MAX_POINTS, Axis, number_or_axis
from rocking.cli.option_names import YourInput

STUDY = (
    "All this in a TOML file, a line an option: restitution = 0.9, an axis in quotes, such as "
    'period = "1:3:60"; what is typed here wins.'
)
Study = Annotated[Path | None, typer.Option("--study", metavar="FILE", help=STUDY)]
MAX_BYTES = 1_000_000
"""In a study file, which has some ten lines."""
Check = Callable[[Any], Any]


def quantity(name: str, given: Any) -> Any:
    """A number, an `Axis`, or a list of values: from a number, a text as it is typed, a table of start, stop and count, a list."""
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
            f"{name} must be a number, {FORM}, or hold start, stop and perhaps count; got {', '.join(given) or 'nothing'}"
        )
    start, stop = (float(reals(f"{part} of {name}", given[part])) for part in ("start", "stop"))
    return Axis(start, stop, whole(f"count of {name}", given.get("count", DEFAULT_COUNT), 2, MAX_POINTS))


def asked(typed: Mapping[str, Any], file: Path | None, checks: Mapping[str, Check]) -> dict[str, Any]:
    """What options and a study file ask for; what is typed wins."""
    given = {} if file is None else read(file, checks)
    return given | {
        name: typed[name] for name in checks if typed[name] is not None and typed[name] is not False
    }


def read(path: Path, checks: Mapping[str, Check]) -> dict[str, Any]:
    """What a study file says, each entry as its check returns it; `YourInput` with all errors of the file at once.

    Its keys are the names of options, with dashes or underscores.
    """
    import tomllib

    try:
        said = tomllib.loads(_text(path))
    except (OSError, ValueError, RecursionError) as error:
        why = getattr(error, "strerror", None) or error
        if isinstance(error, RecursionError):
            why = "it is nested too deeply"
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
    """What is in a file of the usual kind and size: a device may have no end, and a pipe may wait for ever."""
    if path.exists() and not path.is_file() and not path.is_dir():
        raise ValueError("it is no file but a device, a pipe or a socket")
    with path.open("rb") as file:
        content = file.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise ValueError(f"it has more than {MAX_BYTES:,} bytes")
    return content.decode("utf-8-sig")


def _check_once(path: Path, said: Mapping[str, Any]) -> None:
    """Refuse what is said twice, once with dashes and once with underscores."""
    twice = [key for key in said if "-" in key and key.replace("-", "_") in said]
    if twice:
        raise YourInput(f"study {str(path)!r}: {twice[0]!r} is said twice, once with underscores")


def _unknown(name: str, checks: Mapping[str, Check]) -> str:
    """Say of an unknown key which one may be meant."""
    close = difflib.get_close_matches(name, checks, 1)
    meant = f"do you mean {close[0]!r}?" if close else "keys are the names of options"
    return f"unknown {name!r} ({meant})"
