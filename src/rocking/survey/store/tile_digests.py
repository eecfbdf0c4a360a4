"""Digests of the chunks of a tile, which bind them to their survey and to their place in it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from rocking.survey.tiling import Tile

FOLDER = "digests"
"""Folder of the digests, in that of the variable that is written last: programs that read Zarr do not look there."""
CHANGING = ("axes", "halved", "tiles", "made_by")
"""Metadata of a store that change when it is extended, or that are not compared."""


def survey_key(stored: Mapping[str, Any]) -> bytes:
    """Return the digest of what identifies a survey, from the metadata of its store."""
    fixed = {name: value for name, value in stored.items() if name not in CHANGING}
    return hashlib.sha256(json.dumps(fixed, sort_keys=True).encode()).digest()


def digests(survey: bytes, tile: Tile, points: tuple[int, ...], chunks: Mapping[str, bytes]) -> bytes:
    """Return the content of the file of digests of a tile, as JSON.

    Each digest is a SHA-256 of the bytes of a chunk, the name of its variable, and its place. The place is the key of the survey, the
    level, the index and the axis values of the tile. `points` are the numbers of points along each axis when the chunks were
    written. The tile may have become larger.
    """
    place = hashlib.sha256(survey)
    place.update(json.dumps([tile.level.number, tile.index, points]).encode())
    for (name, values), count in zip(tile.axes().items(), points, strict=True):
        place.update(name.encode() + values[:count].astype("<f8").tobytes())
    found = {}
    for name, content in chunks.items():
        own = place.copy()
        own.update(json.dumps(name).encode() + content)
        found[name] = own.hexdigest()
    return json.dumps({"points": points, "sha256": found}).encode()


def wrong(
    survey: bytes, tile: Tile, stored: bytes, chunks: Mapping[str, bytes]
) -> tuple[tuple[int, ...], list[str]]:
    """Return the numbers of points of a stored file of digests, and the variables whose chunks do not match it.

    ValueError is raised if the file is not one of this tile.
    """
    try:
        said = json.loads(stored)
        points, there = tuple(said["points"]), dict(said["sha256"])
        expected = digests(survey, tile, points, chunks)
    except (ValueError, TypeError, KeyError) as error:
        raise ValueError("no digests of a tile") from error
    if stored == expected:
        return points, []
    differing = [name for name, one in json.loads(expected)["sha256"].items() if there.get(name) != one]
    if not differing:
        raise ValueError("no digests of this tile")
    return points, differing
