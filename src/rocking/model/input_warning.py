"""Warning of input that is allowed, but probably not what the user means."""

from __future__ import annotations

import sys
import warnings
from types import FrameType

from rocking.model import keywords

OWN = ("rocking", "attr", "attrs", "contextlib")


class InputWarning(UserWarning):
    """Input that is allowed, but probably not what is meant: a wrong unit, a vertical channel, a peak unlike that of the header.

    The message is one sentence. All warnings of the package have this class. `warnings.simplefilter("error", rk.InputWarning)`
    makes errors of them.

    Examples
    --------
    >>> import rocking as rk
    >>> issubclass(rk.InputWarning, UserWarning)
    True
    """


def warn_of_input(sentence: str) -> None:
    """Warn the user, whose line is the first one outside the package."""
    frame: FrameType | None = sys._getframe(1)
    level = 2
    while frame is not None and _is_own(frame):
        frame, level = frame.f_back, level + 1
    warnings.warn(sentence, InputWarning, stacklevel=level)


def warn_of_value(sentence: str) -> None:
    """Warn of an argument of the calling method or class; the package, which gives such values on purpose, is not warned."""
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and (
        _is_generated(frame) or frame.f_globals.get("__name__") == keywords.__name__
    ):
        frame = frame.f_back
    if frame is not None and not _is_own(frame):
        warn_of_input(sentence)


def _is_generated(frame: FrameType) -> bool:
    return frame.f_code.co_filename.startswith("<attrs generated")


def _is_own(frame: FrameType) -> bool:
    return _is_generated(frame) or str(frame.f_globals.get("__name__")).partition(".")[0] in OWN
