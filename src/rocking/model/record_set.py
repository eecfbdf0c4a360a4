"""Set of ground motions with data about each, for surveys."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.model.arrays import read_only
from rocking.model.formatting import counted
from rocking.model.ground_motion import GroundMotion
from rocking.model.ground_motion_doubts import vertical_sentence
from rocking.model.input_warning import warn_of_input, warn_of_value
from rocking.model.short_texts import shown
from rocking.model.validation import members, reals, refusal

ALLOWED = "hold ground motions, one at least"
REMEDY = "read them with rk.read_ground_motion, or a folder with rk.read_record_set"


def _motions(values: Any) -> tuple[GroundMotion, ...]:
    if isinstance(values, str | os.PathLike):
        raise TypeError(refusal("records", ALLOWED, values, REMEDY))
    found = (values,) if isinstance(values, GroundMotion) else members("records", values, ALLOWED)
    if not found:
        raise ValueError(refusal("records", ALLOWED, values, REMEDY))
    for each in found:
        if not isinstance(each, GroundMotion):
            raise TypeError(refusal("records", ALLOWED, each, REMEDY))
    return found


def _columns(values: Mapping[str, Any]) -> dict[str, np.ndarray]:
    if not isinstance(values, Mapping):
        raise TypeError(refusal("columns", "be a mapping of names to one number per record", values))
    return {
        str(name): read_only(np.atleast_1d(reals(f"columns[{shown(name)}]", column)))
        for name, column in values.items()
    }


@frozen(repr=False, eq=False)
class RecordSet(Sequence[GroundMotion]):
    """Ground motions with distinct names, and columns of data about them.

    Parameters
    ----------
    records : GroundMotion or iterable of GroundMotion
        Motions; at least one. A motion without a name is called "record 1", "record 2", ….
    columns : mapping of str to array_like (n,), optional
        One number per motion, such as magnitudes, or an intensity of the user's own. Default: none.

    Raises
    ------
    TypeError, ValueError
        If a value is of the wrong type. Also if two motions have the same name, or if a column has another length.

    Warns
    -----
    InputWarning
        If a motion is a vertical component: the base of a block moves horizontally.

    See Also
    --------
    read_record_set : Read the files of a folder or of a table.

    Examples
    --------
    >>> import rocking as rk
    >>> records = rk.RecordSet(rk.synthetic_ground_motions(3, seed=1), columns={"magnitude": [6.5, 6.9, 7.2]})
    >>> len(records), records.columns["magnitude"].tolist()
    (3, [6.5, 6.9, 7.2])
    """

    motions: tuple[GroundMotion, ...] = field(alias="records", converter=_motions)
    columns: dict[str, np.ndarray] = field(factory=dict, converter=_columns)

    def __attrs_post_init__(self) -> None:
        if names := self.vertical:
            warn_of_value(vertical_sentence(names))
        seen: set[str] = set()
        for name in self.names:
            if name in seen:
                way_out = "attrs.evolve(motion, name=…) gives another name"
                raise ValueError(refusal("records", "have distinct names", f"{name} twice", way_out))
            seen.add(name)
        for name, column in self.columns.items():
            if column.shape != (len(self.motions),):
                allowed = f"hold {counted(len(self.motions), 'number')}, one per record"
                raise ValueError(refusal(f"columns[{shown(name)}]", allowed, column.tolist()))

    @property
    def names(self) -> tuple[str, ...]:
        """Name and component of each motion."""
        labels = (", ".join(filter(None, (each.name, each.component))) for each in self.motions)
        return tuple(label or f"record {number}" for number, label in enumerate(labels, 1))

    @property
    def digest(self) -> str:
        """SHA-256 of samples, steps and factors of all motions, in their order."""
        found = sha256()
        for each in self.motions:
            base = each.normalised(1.0, 1.0)  # the samples before the factor
            found.update(np.array([base.values.size, base.step, base.scale]).tobytes())
            found.update(base.values.tobytes())
        return found.hexdigest()

    @property
    def vertical(self) -> tuple[str, ...]:
        """Names of the motions whose component is vertical."""
        return tuple(name for name, each in zip(self.names, self.motions, strict=True) if each.vertical)

    def __len__(self) -> int:
        return len(self.motions)

    def __getitem__(self, place: Any) -> Any:
        return self.motions[place]

    def __iter__(self) -> Iterator[GroundMotion]:
        return iter(self.motions)

    def __repr__(self) -> str:
        more = f", columns {', '.join(self.columns)}" if self.columns else ""
        return f"RecordSet({counted(len(self), 'record')}{more})"


def record_set(records: RecordSet | GroundMotion | Iterable[GroundMotion]) -> RecordSet:
    """Return a set of records as it is, and one or more ground motions as a set, with a warning of vertical components."""
    if isinstance(records, RecordSet):
        return records
    found = RecordSet(records)
    if names := found.vertical:
        warn_of_input(vertical_sentence(names))
    return found
