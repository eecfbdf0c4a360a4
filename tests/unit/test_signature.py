"""Arguments and results of entry points as rows of words: round trips, and refusals of arrays of the wrong kind."""

import copy
import math
import pickle
import struct
from typing import Annotated, Generic, NamedTuple, TypeVar

import numpy as np
import pytest

from rocking.kernels.base.samples import tables_of
from rocking.kernels.library.signature import Bytes1, Floats1, Floats2, Signature, chosen_of, place_of_union
from rocking.kernels.motion import finite_motion
from rocking.kernels.system import sampled_system, slender_block

ROW = np.dtype([("time", float), ("side", float)])
Rows = Annotated[np.ndarray, ROW, 1]


class Inner(NamedTuple):
    weight: float
    found: bool


class Outer(NamedTuple):
    count: int
    inner: Inner
    table: Floats2


def function(outer: Outer, rows: Rows, flags: Bytes1, scale: float) -> tuple[int, Inner, bool]:
    """Only the annotations matter."""


SIGNATURE = Signature(function)


def arguments(**other):
    given = {
        "table": np.zeros((3, 4)),
        "rows": np.zeros(5, ROW),
        "flags": np.zeros(0, np.uint8),
    } | other
    return Outer(-7, Inner(0.1, True), given["table"]), given["rows"], given["flags"], -np.inf


def test_words_of_arguments_are_numbers_addresses_and_shapes():
    given = arguments()
    block = SIGNATURE.pack(given)
    words = struct.unpack_from("=qdqqqqqqqqd", block)
    assert words[:3] == (-7, 0.1, 1)
    assert words[3:8] == (given[0].table.ctypes.data, 3, 4, given[1].ctypes.data, 5)
    assert words[9:] == (0, -np.inf)
    assert len(block) == 8 * (SIGNATURE.offset + 4)


def test_result_is_made_of_the_words_behind_the_arguments():
    block = SIGNATURE.pack(arguments())
    struct.pack_into("=qdqq", block, 8 * SIGNATURE.offset, 3, 2.5, 0, 1)
    found = SIGNATURE.unpack(block)
    assert found == (3, Inner(2.5, False), True)
    assert [type(part) for part in (found[0], *found[1], found[2])] == [int, float, bool, bool]


def test_array_that_cannot_be_written_has_its_own_address():
    table = np.ones((3, 4))
    table.flags.writeable = False
    words = struct.unpack_from("=qdqq", SIGNATURE.pack(arguments(table=table)))
    assert words[3] == table.ctypes.data


class LastingFields(NamedTuple):
    table: Floats1
    size: float


class Lasting(LastingFields):
    words = None


def lasting_function(old: Lasting, new: Lasting) -> float:
    """Only the annotations matter."""


def test_values_that_never_change_keep_their_words():
    signature = Signature(lasting_function)
    values = Lasting(np.zeros(3), 0.5), Lasting(np.zeros(4), 1.5)
    expected = (
        *(word for value in values for word in (value.table.ctypes.data, *value.table.shape, value.size)),
    )
    blocks = [signature.pack(values) for _ in range(2)]
    assert [struct.unpack_from("=qqdqqd", block) for block in blocks] == [expected, expected]
    assert values[0].words == expected[:3]


def test_tables_of_a_record_keep_their_words_and_a_copy_does_not():
    """The arrays of a copy have other addresses."""
    tables = tables_of(np.ones(4), 0.1)
    finite_motion.run_to_end(sampled_system(slender_block(0.9), tables, 1.0, 6.4), 0.0, 0.0, math.inf)
    assert tables.words[-1] == tables.variation.size
    for copied in (copy.deepcopy(tables), pickle.loads(pickle.dumps(tables))):
        assert copied.words is None
        np.testing.assert_array_equal(copied.knots, tables.knots)


@pytest.mark.parametrize(
    "wrong",
    [
        {"table": np.zeros((4, 3)).T},
        {"table": np.zeros((3, 8))[:, ::2]},
        {"table": np.zeros(12)},
        {"table": np.zeros((3, 4), np.float32)},
        {"table": np.zeros((3, 4), int)},
        {"rows": np.zeros(5)},
        {"flags": np.zeros(3, np.int8)},
    ],
)
def test_array_of_the_wrong_kind_is_refused(wrong):
    """Compiled code would read and write beyond it."""
    with pytest.raises(TypeError, match="^an array must be contiguous, .*; got "):
        SIGNATURE.pack(arguments(**wrong))


def test_too_few_arguments_are_refused():
    with pytest.raises(ValueError, match="zip"):
        SIGNATURE.pack(arguments()[:-1])


class One(NamedTuple):
    first: float


class Two(NamedTuple):
    first: float
    second: float


class Problem(NamedTuple):
    count: int
    p: One | Two


def test_union_is_found_at_its_place_and_replaced_by_what_is_chosen():
    def solve(scale: float, problem: Problem) -> One | Two: ...

    place, union = place_of_union(list(solve.__annotations__.values())[:2])
    assert (place, union) == ((1, 1), One | Two)
    assert place_of_union([float, Outer]) is None
    for chosen, kind, words in zip(chosen_of(union), (One, Two), (3, 4), strict=True):
        signature = Signature(solve, chosen)
        value = kind(*range(len(kind._fields)))
        block = signature.pack((0.5, Problem(9, value)))
        assert signature.offset == words
        struct.pack_into(f"={len(value)}d", block, 8 * words, *value)
        assert signature.unpack(block) == value
        assert type(signature.unpack(block)) is kind


Base = TypeVar("Base", One, Two)


class Plain(NamedTuple, Generic[Base]):
    forcing: Base


class Held(NamedTuple, Generic[Base]):
    forcing: Base
    inside: Plain[Base]


class Row(NamedTuple):
    of_base: Annotated[Inner | Outer, (Inner, Outer)]
    as_base: One | Two


def test_types_that_depend_on_the_base_follow_the_chosen_system():
    def solve(p: Plain[One] | Plain[Two] | Held[Two], row: Row) -> float: ...

    choices = chosen_of(place_of_union([solve.__annotations__["p"]])[1])
    assert [choice.name for choice in choices] == ["PlainOne", "PlainTwo", "HeldTwo"]
    assert [choice.key for choice in choices] == [(Plain, One), (Plain, Two), (Held, Two)]
    found = [Signature(solve, choice).arguments.types for choice in choices]
    systems, rows = zip(*found, strict=True)
    assert [system.kind for system in systems] == [Plain, Plain, Held]
    assert [[part.kind for part in row.types] for row in rows] == [[Inner, One], [Outer, Two], [Outer, Two]]
    assert systems[2].types[1] == systems[1]
    assert len({Signature(solve, choice).digest for choice in choices}) == 3


class Turned(NamedTuple):
    second: float
    first: float


class Straight(NamedTuple):
    first: float
    second: float


def test_words_of_another_meaning_have_another_digest():
    """The digest is a part of the name of the compiled function, which is otherwise called with words that it misreads."""
    rows = [Annotated[np.ndarray, np.dtype([("a", "f8"), ("b", kind)]), 1] for kind in ("f8", "i8")]
    kinds = [float, int, bool, Floats1, Floats2, Straight, Turned, tuple[float, float], *rows]
    found = set()
    for kind in kinds:
        for result in (None, float):

            def function(value: kind) -> result:
                pass

            found.add(Signature(function).digest)
    assert len(found) == 2 * len(kinds)
