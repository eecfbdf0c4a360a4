"""Entries of the reference: the names that its pages list, in sections, and the text about each name.

A fence ``{names} rocking`` lists public names of a module. The text after it, up to the next fence of this kind or heading, is about
the last of these names. It stands on the page of this name.
"""

import re
from pathlib import Path
from typing import NamedTuple

PAGES = "reference-*.md"
PART = re.compile(
    r"^```(?P<kind>\{names\})? ?(?P<module>.*)\n(?P<body>(?:.*\n)*?)```$|^#+ (?P<title>.*)$", re.MULTILINE
)


class Entry(NamedTuple):
    """Public name in full, and the text about it."""

    name: str
    text: str = ""


class Section(NamedTuple):
    """Section of a page with its entries, and where they stand in the page."""

    title: str
    entries: list[Entry]
    places: list[slice]

    @property
    def names(self):
        """Full names of the entries."""
        return [entry.name for entry in self.entries]


def sections(page):
    """List the sections of a page that hold entries."""
    return sections_of(Path(page).read_text(encoding="utf-8"))


def sections_of(text):
    """List the sections of a text that hold entries."""
    found = [Section("", [], [])]
    parts = [match for match in PART.finditer(text) if match["title"] or match["kind"]]
    ends = [*(match.start() for match in parts[1:]), len(text)]
    for match, end in zip(parts, ends, strict=False):  # a text without parts has an end
        if match["title"]:
            found.append(Section(match["title"], [], []))
            continue
        *others, last = (
            name if "." in name else f"{match['module']}.{name}" for name in match["body"].split()
        )
        found[-1].entries.extend([*map(Entry, others), Entry(last, text[match.end() : end].strip())])
        found[-1].places.append(slice(match.start(), end))
    return [section for section in found if section.entries]


def listed(text):
    """Return the text of a page with one table of names for each section, and without the text about the names."""
    for section in reversed(sections_of(text)):
        # Autosummary, which makes the table, writes reStructuredText.
        fence = "\n".join(
            ["```{eval-rst}", ".. names::", "", *(f"   {name}" for name in section.names), "```\n\n"]
        )
        for place in reversed(section.places):
            text = text[: place.start] + (fence if place == section.places[0] else "") + text[place.stop :]
    return text
