"""Arguments and results of entry points as rows of 8-byte words, by the annotations of functions and named tuples.

A number is one word. A tuple is its fields, one after another. An array is its address and its shape. Where annotations
are unions, a member of the first one is chosen, and of the others the same one, or that of the same base: they list the bases in
the order of the type variable ``Base``. An annotation with a tuple of types is the one for the base.
"""

import ctypes
import hashlib
import struct
from collections.abc import Callable, Iterator
from itertools import chain
from types import UnionType
from typing import Annotated, Any, NamedTuple, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

CODES = {float: "d", int: "q", bool: "q"}
NO_BYTES = ctypes.c_char * 0

Floats1 = Annotated[np.ndarray, np.dtype(np.float64), 1]
Floats2 = Annotated[np.ndarray, np.dtype(np.float64), 2]
Floats3 = Annotated[np.ndarray, np.dtype(np.float64), 3]
Integers1 = Annotated[np.ndarray, np.dtype(np.int64), 1]
Bytes1 = Annotated[np.ndarray, np.dtype(np.uint8), 1]


class Array(NamedTuple):
    """Type of a C-contiguous array."""

    dtype: np.dtype
    dimensions: int


class Fields(NamedTuple):
    """Type of a tuple: its class, and the types of its fields."""

    kind: type
    types: tuple[Any, ...]  # float, int, bool, ``Array`` or ``Fields``


class Chosen(NamedTuple):
    """Member of the first union of an entry point, and its base: where it has one, the place of that among all bases."""

    member: Any
    place: int

    @property
    def key(self) -> Any:
        """What tells an argument of this type: its class, and for a class with a base the class of that."""
        base = get_args(self.member)
        return (get_origin(self.member), base[0]) if base else self.member

    @property
    def name(self) -> str:
        """Name of the member, such as SlenderCosine."""
        return "".join(
            part.__name__ for part in (get_origin(self.member) or self.member, *get_args(self.member))
        )


def chosen_of(union: Any) -> list[Chosen]:
    """Return the members of a union, as the choices of an entry point."""
    members = []
    for k, member in enumerate(get_args(union)):
        base = get_args(member)
        place = k
        if base:  # a base may have the drives and the constants of another one
            bases = get_origin(member).__parameters__[0].__constraints__
            place = bases.index(getattr(base[0], "LIKE", base[0]))
        members.append(Chosen(member, place))
    return members


def types_of(kind: Any) -> list[Any]:
    """Return the annotations of the fields of a named tuple; those of a generic one are given its base."""
    origin, base = get_origin(kind) or kind, get_args(kind)
    hints = get_type_hints(origin, include_extras=True).values()
    if not base:
        return list(hints)
    return [
        base[0] if isinstance(hint, TypeVar) else hint[base] if getattr(hint, "__parameters__", ()) else hint
        for hint in hints
    ]


def is_union(kind: Any) -> bool:
    """Return whether an annotation is a union."""
    return get_origin(kind) in (Union, UnionType)


def place_of_union(kinds: list[Any]) -> tuple[tuple[int, ...], Any] | None:
    """Find the first union in the annotations of a tuple: its place, as an index for each level, and the union."""
    for k, kind in enumerate(kinds):
        if is_union(kind):
            return (k,), kind
        if isinstance(kind, type) and hasattr(kind, "_fields"):
            inner = place_of_union(types_of(kind))
            if inner:
                return (k, *inner[0]), inner[1]
    return None


def resolve(kind: Any, chosen: Chosen | None) -> Any:
    """Return the type that an annotation stands for: float, int, bool, ``Array`` or ``Fields``; of a union the chosen member."""
    if is_union(kind):
        if chosen is None:
            raise TypeError(f"a member of {kind} must be chosen")
        members = get_args(kind)
        return resolve(chosen.member if chosen.member in members else members[chosen.place], chosen)
    if kind in CODES:
        return kind
    if get_origin(kind) is Annotated:
        meant = get_args(kind)[1:]
        return Array(*meant) if len(meant) == 2 else resolve(meant[0][chosen.place], chosen)
    if get_origin(kind) is tuple:
        return Fields(tuple, tuple(resolve(part, chosen) for part in get_args(kind)))
    return Fields(get_origin(kind) or kind, tuple(resolve(part, chosen) for part in types_of(kind)))


def codes_of(kind: Any) -> str:
    """Return the format of ``struct`` for the words of a type."""
    if isinstance(kind, Array):
        return "q" * (1 + kind.dimensions)
    return "".join(map(codes_of, kind.types)) if isinstance(kind, Fields) else CODES[kind]


def text_of(kind: Any) -> str:
    """Return a text that differs for types whose words have another meaning."""
    if isinstance(kind, Array):
        return f"{kind.dtype.str}{kind.dtype.descr}{kind.dimensions}"
    if not isinstance(kind, Fields):
        return str(getattr(kind, "__name__", kind))
    names = getattr(kind.kind, "_fields", range(len(kind.types)))
    parts = (f"{name}:{text_of(part)}" for name, part in zip(names, kind.types, strict=True))
    return f"{kind.kind.__name__}({','.join(parts)})"


def address_of(array: np.ndarray) -> int:
    """Return the address of an array."""
    try:
        return ctypes.addressof(NO_BYTES.from_buffer(array))  # six times as fast as NumPy's way
    except TypeError:  # the array cannot be written
        return array.ctypes.data


def lister_of(kind: Any) -> Callable[[Any], Any]:
    """Make the function that returns the words of a value of a type.

    It raises ``TypeError`` for an array of another type, of other dimensions, or not contiguous.
    """
    if isinstance(kind, Array):
        dtype, dimensions = kind

        def words_of_array(value: np.ndarray) -> tuple[int, ...]:
            if value.dtype != dtype or value.ndim != dimensions or not value.flags.c_contiguous:
                expected, found = f"{dimensions}-d {dtype}", f"{value.ndim}-d {value.dtype}"
                raise TypeError(f"an array must be contiguous, {expected}; got {found}")
            return address_of(value), *value.shape

        return words_of_array
    if not isinstance(kind, Fields):
        return lambda value: (value,)
    if all(part in CODES for part in kind.types):
        return lambda value: value
    parts = [lister_of(part) for part in kind.types]

    def words_of_fields(value: Any) -> Any:
        return chain.from_iterable([part(field) for part, field in zip(parts, value, strict=True)])

    return lasting(words_of_fields) if hasattr(kind.kind, "words") else words_of_fields


def lasting(words: Callable[[Any], Any]) -> Callable[[Any], tuple[Any, ...]]:
    """Return the function of words for values that never change and keep theirs in ``words``: each address costs a microsecond."""

    def words_of_lasting(value: Any) -> tuple[Any, ...]:
        if value.words is None:
            value.words = tuple(words(value))
        return value.words  # type: ignore[no-any-return]

    return words_of_lasting


def maker_of(kind: Any) -> Callable[[Iterator[Any]], Any]:
    """Make the function that makes a value of a type from an iterator over its words."""
    if not isinstance(kind, Fields):
        return (lambda words: bool(next(words))) if kind is bool else next
    parts = [maker_of(part) for part in kind.types]
    make = tuple if kind.kind is tuple else kind.kind._make
    return lambda words: make([part(words) for part in parts])


class Signature:
    """Types of the arguments and of the result of an entry point, from the annotations of its function."""

    def __init__(self, function: Callable[..., Any], chosen: Chosen | None = None) -> None:
        hints = get_type_hints(function, include_extras=True)
        result = hints.pop("return")
        self.arguments = Fields(tuple, tuple(resolve(kind, chosen) for kind in hints.values()))
        returned = [] if result is type(None) else [resolve(result, chosen)]
        self.result = returned[0] if returned else None
        self._taken = struct.Struct("=" + codes_of(self.arguments))
        self._given = struct.Struct("=" + "".join(map(codes_of, returned)))
        self._list = lister_of(self.arguments)
        self._make = maker_of(returned[0]) if returned else lambda words: None

    @property
    def offset(self) -> int:
        """Number of words of the arguments; those of the result follow."""
        return self._taken.size // 8

    @property
    def digest(self) -> str:
        """Digits that differ for signatures whose words have another meaning."""
        text = f"{text_of(self.arguments)} -> {text_of(self.result)}"
        return hashlib.sha256(text.encode()).hexdigest()[:8]

    def pack(self, arguments: tuple[Any, ...]) -> bytearray:
        """Write the words of the arguments, with room for those of the result behind them."""
        block = bytearray(self._taken.size + self._given.size)
        self._taken.pack_into(block, 0, *self._list(arguments))
        return block

    def unpack(self, block: bytearray) -> Any:
        """Make the result from its words."""
        return self._make(iter(self._given.unpack_from(block, self._taken.size)))
