"""Study files: options of a command in TOML; all errors of a file are reported together."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import click

from rocking.cli.options import FILE, InvalidInput, Value, make

TEXT = (
    'Read options from a TOML file, for example restitution = 0.9 or period = "1:3:60". '
    "Options on the command line take precedence."
)
MAX_BYTES = 1_000_000
"""Maximum size of a study file; a typical one has ten lines."""
NO_KEYS = ("study", "json", "help")
"""Options that a study file cannot give."""


def study_option(*, checked: bool) -> click.Option:
    """Make the option `--study`: the entries of the file replace the defaults of the other options.

    With `checked`, entries are checked as values of a survey, too.
    """

    def fill(context: click.Context, _: click.Parameter, path: Path | None) -> Path | None:
        if path is not None:
            context.default_map = read(path, context.command.params, checked=checked)
        return path

    return make("study", FILE, "FILE", TEXT, is_eager=True, callback=fill)


def read(path: Path, parameters: Collection[click.Parameter], *, checked: bool) -> dict[str, Any]:
    """Return the entries of a study file as values of options; InvalidInput with all errors of the file.

    Keys are the names of options, with hyphens or underscores.
    """
    from rocking.cli.requests import check_entry
    from rocking.model.validation import similar

    entries = entries_of(path)
    check_once(path, entries)
    keys = {key.replace("-", "_"): key for key in entries}
    known = {
        each.name: each for each in parameters if isinstance(each, click.Option) and each.name not in NO_KEYS
    }
    values: dict[str, Any] = {}
    errors: list[str] = []
    for name in filter(keys.__contains__, known):
        try:
            values[name] = value_of(known[name], keys[name], entries[keys[name]])
            if checked:
                check_entry(keys[name], name, values[name])
        except (TypeError, ValueError) as error:
            errors.append(str(error))
    unknown = sorted(keys.keys() - known.keys())
    errors += [unknown_key(keys[name], entries[keys[name]], known) for name in unknown]
    if any(similar(name, known) is None and not is_section(entries[keys[name]]) for name in unknown):
        errors.append("keys of this command: " + ", ".join(name.replace("_", "-") for name in known))
    if errors:
        raise InvalidInput(f"study {quoted(path)}: " + "; ".join(errors))
    return values


def value_of(parameter: click.Option, key: str, entry: Any) -> Any:
    """Return the value of an entry for an option; TypeError or ValueError if it has none."""
    from rocking.model.validation import instance

    if parameter.is_flag:
        return instance(key, entry, bool)
    kind = parameter.type
    assert isinstance(kind, Value)
    if parameter.multiple:
        return [kind.entry(key, each) for each in (entry if isinstance(entry, list) else [entry])]
    return kind.entry(key, entry)


def entries_of(path: Path) -> dict[str, Any]:
    """Return the keys and values of a study file; InvalidInput if it cannot be read."""
    import tomllib

    try:
        return tomllib.loads(text_of(path))
    except (OSError, ValueError, RecursionError) as error:
        reason = getattr(error, "strerror", None) or error
        if isinstance(error, RecursionError):
            reason = "the file is nested too deeply"
        elif isinstance(error, UnicodeDecodeError):
            reason = "the file is not text in UTF-8"
        raise InvalidInput(f"--study must name a TOML file; got {quoted(path)}: {reason}") from error


def text_of(path: Path) -> str:
    """Return the text of a regular file of limited size: reading a device or a pipe may never end."""
    if path.exists() and not path.is_file() and not path.is_dir():
        raise ValueError("not a regular file but a device, a pipe or a socket")
    with path.open("rb") as file:
        content = file.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise ValueError(f"the file has more than {MAX_BYTES:,} bytes")
    return content.decode("utf-8-sig")


def check_once(path: Path, entries: Mapping[str, Any]) -> None:
    """Raise InvalidInput for a key that occurs with hyphens and with underscores."""
    twice = [key for key in entries if "-" in key and key.replace("-", "_") in entries]
    if twice:
        raise InvalidInput(
            f"study {quoted(path)}: {twice[0]!r} occurs twice, with hyphens and with underscores (remove one)"
        )


def unknown_key(key: str, entry: Any, known: Collection[str]) -> str:
    """Return the message for an unknown key as written in the file, with a known one if it is similar."""
    from rocking.model.validation import similar

    if is_section(entry):
        return f"unknown {key!r} (a section: write the keys of options without sections)"
    near = similar(key.replace("-", "_"), known)
    if near is None:
        return f"unknown {key!r}"
    return f"unknown {key!r} (did you mean {near if '_' in key else near.replace('_', '-')!r}?)"


def is_section(entry: Any) -> bool:
    """Return whether an entry is a table other than an axis or a range."""
    return isinstance(entry, Mapping) and not {"start", "stop"} & entry.keys()


def with_keys(message: str, path: Path, typed: Collection[str]) -> str:
    """Return a message with the keys of a study file that give the options named in it, except options `typed` as well."""
    named = [
        key
        for key in entries_of(path)
        if key.replace("-", "_") not in typed
        and re.search(rf"(?<![\w-])--?{re.escape(key.replace('_', '-'))}(?![\w-])", message)
    ]
    return f"{message} (study {quoted(path)} gives {', '.join(named)})" if named else message


def quoted(path: Path) -> str:
    """Return a path in quotation marks."""
    from rocking.model.text import formatted_path

    return formatted_path(path)
