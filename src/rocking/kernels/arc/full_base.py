"""Motion of the base as the full block needs it: a cosine, a piece of one (a pulse), and samples.

From the end of a pulse on, cos psi and sin psi of its drive are 0, and so is the base acceleration. A step ends with the pulse,
or with an interval between samples, at the latest.
"""

import math

from rocking.kernels import contract
from rocking.kernels.arc.full_series import (
    cosine_series,
    cosine_transfer,
    linear_series,
    linear_transfer,
    short_cosine_series,
    short_linear_series,
)
from rocking.kernels.base.biaxial import Biaxial
from rocking.kernels.base.cosine import Cosine, HarmonicConstants, HarmonicDrive, Pulse, PulseDrive
from rocking.kernels.base.samples import (
    SampledConstants,
    SampledDrive,
    Samples,
    interval,
    last_index,
    place_at,
)
from rocking.kernels.contract import drive_on_clock, wave_of
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import angle_of, circular, cosine_of, exponential_bound, sine_of
from rocking.kernels.system import Full


@body(contract.wave_of, Full, Cosine, inline=True)
def whole(p):
    """Provide ``contract.wave_of`` for a cosine."""
    return p.forcing


@body(contract.wave_of, Full, Pulse, inline=True)
def wave_of_pulse(p):
    """Provide ``contract.wave_of`` for a pulse."""
    return p.forcing.during


@body(contract.series_from, Full, Cosine, Pulse, inline=True)
def series_from(p, side, slope, sine, cosine, drive, short):
    """Provide ``contract.series_from``."""
    wave = wave_of(p)
    size, scale = side * p.block.critical_angle * wave.amplitude, -1.0 / p.block.critical_angle
    g, h, frequency = size * drive.cosine, size * drive.sine, wave.frequency
    if short:
        return short_cosine_series(slope, sine, cosine, scale, g, h, frequency)
    return cosine_series(slope, sine, cosine, scale, g, h, frequency)


@body(contract.transfer_series, Full, Cosine, Pulse, inline=True)
def transfer_series(p, side, slope, sine, cosine, drive):
    """Provide ``contract.transfer_series``."""
    wave = wave_of(p)
    size = side * p.block.critical_angle * wave.amplitude
    return cosine_transfer(slope, sine, cosine, size * drive.cosine, size * drive.sine, wave.frequency)


@body(contract.acceleration_of, Full, Cosine, Pulse, inline=True)
def acceleration_of(p, drive):
    """Provide ``contract.acceleration_of``."""
    return wave_of(p).amplitude * drive.cosine


@kernel(inline=True)
def later_phase(p, drive, time):
    """Return cos psi and sin psi a time later."""
    sine, versine, _, _ = circular(wave_of(p).frequency, time)
    cosine = 1.0 - versine
    return drive.cosine * cosine - drive.sine * sine, drive.sine * cosine + drive.cosine * sine


@kernel(inline=True)
def phase_at(p, time):
    """Return the forcing phase at a time."""
    wave = wave_of(p)
    return wave.frequency * time + wave.phase


@body(contract.largest_within, Full, Cosine, Pulse, inline=True)
def largest_within(p, drive, time):
    """Provide ``contract.largest_within``."""
    return wave_of(p).amplitude


@kernel(inline=True)
def bound_near(p, radius):
    """Return an upper bound of |A cos| in the complex disc around any instant."""
    wave = wave_of(p)
    return wave.amplitude * exponential_bound(wave.frequency * radius) if wave.amplitude > 0.0 else 0.0


@body(contract.smooth_time, Full, Cosine, inline=True)
def smooth_time(p, drive):
    """Provide ``contract.smooth_time``."""
    return math.inf


@body(contract.drive_later, Full, Cosine, inline=True)
def drive_later(p, drive, time, to_corner):
    """Provide ``contract.drive_later``."""
    cosine, sine = later_phase(p, drive, time)
    return HarmonicDrive(cosine, sine)


@body(contract.drive_on_clock, Full, Cosine, inline=True)
def drive_at_start(p, cycle, start):
    """Provide ``contract.drive_on_clock``."""
    psi = phase_at(p, start)
    return HarmonicDrive(cosine_of(psi), sine_of(psi))


@body(contract.largest_ahead, Full, Cosine, inline=True)
def largest_ahead(p, side, drive):
    """Provide ``contract.largest_ahead``."""
    return p.forcing.amplitude


@body(contract.largest_near, Full, Cosine, inline=True)
def largest_near(p, drive, radius):
    """Provide ``contract.largest_near``."""
    return bound_near(p, radius)


@body(contract.drive_after_event, Full, Cosine, inline=True)
def drive_after_event(p, start, coming):
    """Provide ``contract.drive_after_event``."""
    return drive_on_clock(p, 0, start)


@body(contract.constants_at, Full, Cosine, inline=True)
def constants_at(p, start, drive):
    """Provide ``contract.constants_at``."""
    return HarmonicConstants(phase_at(p, start), 0.0)


@kernel(inline=True)
def pulse_drive(p, time):
    """Return the drive at a time since the start of the pulse."""
    if time >= p.forcing.duration:
        return PulseDrive(time, 0.0, 0.0)
    psi = phase_at(p, time)
    return PulseDrive(time, cosine_of(psi), sine_of(psi))


@body(contract.smooth_time, Full, Pulse, inline=True)
def time_to_end(p, drive):
    """Provide ``contract.smooth_time``: to the end of the pulse."""
    left = p.forcing.duration - drive.time
    return left if left > 0.0 else math.inf


@body(contract.drive_later, Full, Pulse, inline=True)
def pulse_later(p, drive, time, to_corner):
    """Provide ``contract.drive_later``."""
    then = p.forcing.duration if to_corner else drive.time + time
    if then >= p.forcing.duration:
        return PulseDrive(then, 0.0, 0.0)
    cosine, sine = later_phase(p, drive, time)
    return PulseDrive(then, cosine, sine)


@body(contract.drive_on_clock, Full, Pulse, inline=True)
def pulse_on_clock(p, cycle, start):
    """Provide ``contract.drive_on_clock``."""
    return pulse_drive(p, cycle * p.clock.cycle_length + start)


@body(contract.largest_ahead, Full, Pulse)
def largest_of_pulse(p, side, drive):
    """Provide ``contract.largest_ahead``: the amplitude if a crest is still to come, else the present or the last value."""
    if drive.time >= p.forcing.duration:
        return 0.0
    wave = p.forcing.during
    turn = wave.frequency * (p.forcing.duration - drive.time)
    to_crest = -angle_of(side * drive.sine, side * drive.cosine)
    if (to_crest if to_crest >= 0.0 else to_crest + 2.0 * math.pi) <= turn:
        return wave.amplitude
    last = drive.cosine * cosine_of(turn) - drive.sine * sine_of(turn)
    return wave.amplitude * max(side * drive.cosine, side * last, 0.0)


@body(contract.largest_push, Full, Pulse, inline=True)
def largest_push_of_pulse(p):
    """Provide ``contract.largest_push``."""
    return p.forcing.during.amplitude


@body(contract.largest_near, Full, Pulse, inline=True)
def near_in_pulse(p, drive, radius):
    """Provide ``contract.largest_near``."""
    return 0.0 if drive.time >= p.forcing.duration else bound_near(p, radius)


@body(contract.drive_after_event, Full, Pulse, inline=True)
def pulse_after_event(p, start, coming):
    """Provide ``contract.drive_after_event``: from the clock, whose whole cycles follow from the time of the event."""
    cycle = round((coming.drive.time - start) / p.clock.cycle_length)
    return drive_on_clock(p, cycle, start)


@body(contract.constants_at, Full, Pulse, inline=True)
def pulse_constants(p, start, drive):
    """Provide ``contract.constants_at``."""
    return HarmonicConstants(phase_at(p, drive.time), 0.0)


@body(contract.series_from, Full, Samples, inline=True)
def series_under_samples(p, side, slope, sine, cosine, drive, short):
    """Provide ``contract.series_from``."""
    alpha = p.block.critical_angle
    start, rate = interval(p, drive.index)
    size, scale = side * alpha, -1.0 / alpha
    now, change = size * (start + rate * drive.offset), size * rate
    if short:
        return short_linear_series(slope, sine, cosine, scale, now, change)
    return linear_series(slope, sine, cosine, scale, now, change)


@body(contract.transfer_series, Full, Samples, inline=True)
def transfer_under_samples(p, side, slope, sine, cosine, drive):
    """Provide ``contract.transfer_series``."""
    start, rate = interval(p, drive.index)
    size = side * p.block.critical_angle
    return linear_transfer(slope, sine, cosine, size * (start + rate * drive.offset), size * rate)


@body(contract.smooth_time, Full, Samples, Biaxial, inline=True)
def time_to_sample(p, drive):
    """Provide ``contract.smooth_time``: to the next sample."""
    return max(p.forcing.tables.step - drive.offset, 0.0) if drive.index < last_index(p) else math.inf


@body(contract.drive_later, Full, Samples, Biaxial, inline=True)
def place_later(p, drive, time, to_corner):
    """Provide ``contract.drive_later``."""
    if to_corner:
        return SampledDrive(drive.index + 1, 0.0)
    return SampledDrive(drive.index, drive.offset + time)


@body(contract.drive_on_clock, Full, Samples, Biaxial, inline=True)
def place_on_clock(p, cycle, start):
    """Provide ``contract.drive_on_clock``."""
    return place_at(p, 0, max(cycle * p.clock.cycle_length + start, 0.0))


@body(contract.largest_ahead, Full, Samples, Biaxial, inline=True)
def largest_sample(p, side, drive):
    """Provide ``contract.largest_ahead``: the largest of all samples, 0 after the last."""
    return abs(p.forcing.scale) * p.forcing.tables.largest if drive.index < last_index(p) else 0.0


@body(contract.largest_push, Full, Samples, Biaxial, inline=True)
def largest_push_of_samples(p):
    """Provide ``contract.largest_push``."""
    return abs(p.forcing.scale) * p.forcing.tables.largest


@body(contract.largest_within, Full, Samples, inline=True)
def largest_of_samples(p, drive, time):
    """Provide ``contract.largest_within``."""
    start, rate = interval(p, drive.index)
    return abs(start + rate * drive.offset) + abs(rate) * time


@body(contract.largest_near, Full, Samples, inline=True)
def largest_near_samples(p, drive, radius):
    """Provide ``contract.largest_near``: the bound on a line is that on a circle, too."""
    return largest_of_samples(p, drive, radius)


@body(contract.drive_after_event, Full, Samples, Biaxial, inline=True)
def place_of_event(p, start, coming):
    """Provide ``contract.drive_after_event``."""
    return coming.drive


@body(contract.constants_at, Full, Samples, Biaxial, inline=True)
def no_constants(p, start, drive):
    """Provide ``contract.constants_at``."""
    return SampledConstants(0.0, 0.0)
