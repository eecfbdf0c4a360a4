"""Ground motions from files: the format is recognised by the content, units are never guessed."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rocking.model.changed_motion import STEPS
from rocking.model.ground_motion import BASELINES, GroundMotion, RecordFile, pga_doubt
from rocking.model.validation import RecordError, Refusal, one_of, warn_of_input, whole, within
from rocking.records import columns, cosmos, counted, csmip, esm, geonet, knet, obspy_streams, peer, smc
from rocking.records.text_file import Channel, Content, TextFile
from rocking.records.units import UNITS, given_unit, stated_once, unit_of_samples

FORMATS: tuple[Any, ...] = (cosmos, smc, esm, geonet, knet, peer, csmip, counted, columns)
"""Readers in the order in which they are tried; any text of numbers has columns."""


MAX_USUAL_STEP = 1.0
"""Largest time step without a warning, s."""


class _Source(NamedTuple):
    """Channels of a file or of a Stream, with the name and the digest of the file."""

    name: str
    sha256: str | None
    channels: list[Channel]


class _Settings(NamedTuple):
    """Arguments that state what the file may leave open."""

    unit: str | None
    step: float | None
    baseline: str


def read_ground_motion(
    source: str | os.PathLike[str] | bytes | Any,
    channel: int = 1,
    *,
    units: str | None = None,
    step: float | None = None,
    baseline: str = "none",
    name: str | None = None,
) -> GroundMotion:
    """Read one channel of a record file.

    The format is recognised by the content:

    - PEER AT2, COSMOS V1 and V2, CSMIP/CDMG V1 and V2, USC V2, SMC;
    - K-NET and KiK-net ASCII, ESM ASCII, GeoNet V1A and V2A;
    - text with one column (acceleration), two (time, acceleration), or more under a line of titles such as time,NS,EW,UD; above one
      column a line may state the step, such as dt = 0.01 s;
    - text with the number of samples and the time step before the samples, in lines of any length;
    - miniSEED, SAC and Kinemetrics files, if ObsPy is installed.

    A file has at most 300 MB, and a line of text at most 10,000 characters.

    Parameters
    ----------
    source : path, bytes, or Stream or Trace of ObsPy
        File, its contents in memory, or traces in memory.
    channel : int
        Channel of the file, counted from 1. Default: 1.
    units : {"m/s²", "cm/s²", "mm/s²", "g", "gal"}
        Unit of the samples, for a file that does not state it. Spellings such as "m/s2" are understood. Default: None.
    step : float
        Time step in s, for a file that does not state it. If a column holds the times, `step` decides among those that agree with
        rounded times. At uneven times, the motion is that of straight lines between the samples, taken at this step. Default: None.
    baseline : {"none", "mean", "linear", "quadratic"}
        Polynomial that is subtracted, as for `GroundMotion`. Default: "none".
    name : str, optional
        Name of the file, for bytes. Default: "bytes".

    Returns
    -------
    GroundMotion
        Motion with its `file`.

    Raises
    ------
    RecordError
        If the file cannot be read, or if unit or step are stated twice or not at all, counting file and arguments. Also if `step`
        contradicts equidistant times.
    TypeError, ValueError
        If an argument is of the wrong type or lies outside its range.

    Warns
    -----
    InputWarning
        If the step follows from coarsely rounded times, or if uneven times are resampled. If the peak of the samples differs from
        the peak in the header: see `RecordFile.pga_agrees`. Also if the PGA is below 0.01 or above 50 m/s², or the step above 1 s:
        the unit is probably another. Also if the header names several units, or mentions another unit than `units`.

    See Also
    --------
    read_ground_motions : All channels of a file.
    example_ground_motion : The motion that comes with the package.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "pulse.csv"
    >>> _ = path.write_text("time (s), acceleration (g)" + chr(10) + "0, 0" + chr(10) + "0.02, 0.1" + chr(10))
    >>> read_ground_motion(path)
    GroundMotion(pulse.csv, 2 samples, step 0.02 s, PGA 0.9807 m/s²)
    """
    settings = _settings(units, step, baseline)
    result = _source(source, name)
    count = len(result.channels)
    number = whole("channel", channel, 1, 10**9)
    if number > count:
        raise Refusal("channel", f"be 1 to {count}, the channels of {result.name}", channel)
    return _warned(result, number, *_motion(result, number, settings))


def read_ground_motions(
    source: str | os.PathLike[str] | bytes | Any,
    *,
    units: str | None = None,
    step: float | None = None,
    baseline: str = "none",
    name: str | None = None,
) -> tuple[GroundMotion, ...]:
    """Read all channels of a record file, in their order.

    Parameters
    ----------
    source, units, step, baseline, name
        As for `read_ground_motion`.

    Returns
    -------
    tuple of GroundMotion
        One motion per channel.

    Raises
    ------
    RecordError, TypeError, ValueError
        As for `read_ground_motion`.

    Warns
    -----
    InputWarning
        As for `read_ground_motion`.

    See Also
    --------
    read_ground_motion : One channel of a file.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "pulse.txt"
    >>> _ = path.write_text("0 1.5 -2 0".replace(" ", chr(10)))
    >>> [motion.pga for motion in read_ground_motions(path, units="m/s²", step=0.01)]
    [2.0]
    """
    settings = _settings(units, step, baseline)
    result = _source(source, name)
    numbers = range(1, len(result.channels) + 1)
    return tuple(_warned(result, number, *_motion(result, number, settings)) for number in numbers)


def read_with_warnings(
    data: bytes, *, units: str | None, step: float | None, name: str
) -> list[tuple[GroundMotion, list[str]]]:
    """Return all channels as `read_ground_motions` does, each with the sentences of its warnings."""
    settings = _settings(units, step, "none")
    result = _source(data, name)
    return [_motion(result, number, settings) for number in range(1, len(result.channels) + 1)]


def _settings(units: str | None, step: float | None, baseline: str) -> _Settings:
    return _Settings(
        None if units is None else given_unit(units),
        None if step is None else within("step", step, *STEPS, "s"),
        one_of("baseline", baseline, tuple(BASELINES)),
    )


def _source(source: Any, name: str | None) -> _Source:
    if name is None and obspy_streams.is_stream(source):
        own = type(source).__name__
        return _Source(own, None, obspy_streams.channels_of(source, own, "ObsPy"))
    content = Content(source, name)
    text = TextFile(content) if content.is_text else None
    form = next((form for form in FORMATS if text and form.recognises(text)), None)
    if text is None or form is None:
        channels = obspy_streams.read(content, columns.unlike(text) if text else ": a binary file")
    else:
        channels = form.read(text)
    return _Source(content.name, content.sha256, channels)


def _place(source: _Source, number: int) -> str:
    return f"{source.name}, channel {number}" if len(source.channels) > 1 else source.name


def _warned(source: _Source, number: int, motion: GroundMotion, messages: list[str]) -> GroundMotion:
    for doubt in messages:
        warn_of_input(f"{_place(source, number)}: {doubt}")
    return motion


def _motion(source: _Source, number: int, settings: _Settings) -> tuple[GroundMotion, list[str]]:
    """Return the motion of a channel, and a sentence on each doubt about its unit."""
    channel, several = source.channels[number - 1], len(source.channels) > 1
    place = _place(source, number)
    unit, messages = unit_of_samples(place, channel.unit, channel.header, settings.unit)
    raw, step, change = channel.samples, channel.step, ""
    if channel.times is None:
        step = stated_once(place, "step", step, settings.step, "its time step", "0.01")
    else:
        raw, step, change, doubt = channel.times.sampled(place, raw, settings.step)
        messages += filter(None, [doubt])
    samples = raw * UNITS[unit]
    name, component = (" ".join(text.split()) for text in (channel.name, channel.component))
    file = None
    if source.sha256 is not None:
        file = RecordFile(
            source.name,
            source.sha256,
            channel.format,
            ", ".join(filter(None, (f"channel {number} of {len(source.channels)}", component)))
            if several
            else "",
            float(np.abs(channel.samples).max()) * UNITS[unit],
            header_pga=channel.peak.size if channel.peak else None,
            header_rounding=channel.peak.rounding if channel.peak else 0.0,
            station=name,
        )
    try:
        motion = GroundMotion(
            samples,
            step=step,
            name=name or source.name,
            component=component,
            baseline=settings.baseline,
            file=file,
            changes=[change] if change else (),
        )
    except ValueError as error:
        raise RecordError(f"{place}: {error}") from error
    if motion.step > MAX_USUAL_STEP:
        messages.append(f"a time step of {motion.step:g} s is unusual: times are in s")
    if doubt := pga_doubt(float(np.abs(samples).max())):
        messages.append(f"{doubt}, {unit}")
    if file is not None and file.pga_agrees is False:
        messages.append(
            f"the samples have a PGA of {file.pga:.5g} m/s², the header states {file.header_pga:.5g} m/s²"
        )
    return motion, messages


MAX_MEMORY = 4 << 30
"""Largest address space of the process in bytes, where the operating system has such a limit."""


def read_apart(data: bytes, seconds: float, **settings: Any) -> list[tuple[GroundMotion, list[str]]]:
    """Read all channels of a file in memory as `read_with_warnings` does; `RecordError` if it takes longer than `seconds`."""
    # The same modules as here, and one thread: each thread of OpenBLAS takes address space.
    same = {"PYTHONPATH": os.pathsep.join(sys.path), "OPENBLAS_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-c", f"from {__name__} import answer; answer()"],
            input=pickle.dumps((data, settings, MAX_MEMORY)),
            capture_output=True,
            timeout=seconds,
            env=os.environ | same,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise RecordError(f"reading takes longer than {seconds:g} s: give a shorter file") from None
    if done.returncode:
        raise RuntimeError(done.stderr.decode(errors="replace"))
    result: list[tuple[GroundMotion, list[str]]] | Exception = pickle.loads(done.stdout)
    if isinstance(result, Exception):
        raise result
    return result


def answer() -> None:
    """Read the file that comes on stdin, and write its channels, or the error, on stdout."""
    data, settings, memory = pickle.load(sys.stdin.buffer)
    with suppress(ImportError, ValueError, OSError):  # no such limit on Windows; a lower one stays
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    result: list[tuple[GroundMotion, list[str]]] | Exception
    try:
        result = read_with_warnings(data, **settings)
    except MemoryError:
        result = RecordError(f"reading takes more than {memory >> 20:,} MB of memory: give a shorter file")
    except (ValueError, TypeError) as error:
        result = error
    sys.stdout.buffer.write(pickle.dumps(result))


FILE = Path(__file__).with_name("0111a.smc")


def example_ground_motion() -> GroundMotion:
    """Return a record of the Loma Prieta earthquake of 1989: San Francisco, 1295 Shafter, component 360°.

    An instrument of the US Geological Survey recorded it: Open-File Report 89-568, in the public domain.

    Returns
    -------
    GroundMotion
        30 s with a PGA of 1.04 m/s².

    See Also
    --------
    read_ground_motion : The motion in a file of your own.
    synthetic_ground_motions : Motions that no instrument recorded.

    Examples
    --------
    >>> motion = example_ground_motion()
    >>> motion.file.name, motion.component, round(motion.pga, 4), motion.duration
    ('0111a.smc', '360°', 1.0441, 30.0)
    """
    return read_ground_motion(FILE)
