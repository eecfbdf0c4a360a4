"""Entries of the reference pages: the names that each section documents."""

import re
from pathlib import Path
from typing import NamedTuple

HEADING_OR_ENTRY = re.compile(
    r"^(?:#+ (?P<title>.*)|\.\. (?P<directive>\w+):: (?P<name>[\w.]+))", re.MULTILINE
)


class Section(NamedTuple):
    """Section of a page with the full names that it documents."""

    title: str
    names: list[str]


def sections(page):
    """List the sections of a page that hold entries."""
    found, module = [], ""
    for match in HEADING_OR_ENTRY.finditer(Path(page).read_text(encoding="utf-8")):
        title, directive, name = match.group("title", "directive", "name")
        if title:
            found.append(Section(title, []))
        elif directive == "currentmodule":
            module = name
        elif directive.startswith("auto"):
            found[-1].names.append(name if name.startswith("rocking.") else f"{module}.{name}")
    return [section for section in found if section.names]
