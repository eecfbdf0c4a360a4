"""Responses by brute force: textbook closed form in plain doubles, sample by sample, to the last cycle.

Nothing is decided early: the label follows from the states of the last cycles alone. The code is compiled, and shares
nothing with the package except the equations of motion. Samples are so close that an event missed between two of them
is smaller than rounding.
"""

import math

import numpy as np
from numba import njit

DENSITY = 120  # samples a period and a time constant, at least
STILL = 1e-9  # speed at which chatter counts as finished
LONGEST = 64  # periods looked for
RETURN = 1e-6
BOUNDED, OVERTURNED, AT_REST = range(3)


def label(amplitude, period, restitution, cycles):
    """Return ("overturned" | "rest" | "else", 0) or ("periodic", n) for the response from rest after ``cycles``."""
    ended, rows = march(amplitude, 2 * math.pi / period, restitution, cycles, np.empty((2 * LONGEST, 2)))
    if ended != BOUNDED:
        return ("overturned", 0) if ended == OVERTURNED else ("rest", 0)
    for lag in range(1, LONGEST + 1):
        if np.abs(rows[lag:] - rows[:-lag]).max() <= RETURN * max(1.0, np.abs(rows).max()):
            return "periodic", lag
    return "else", 0


@njit
def at(time, u, v, side, psi, omega, ripple):
    """u = |Θ| and u' a time later on one side: eq. (5), differences of sines and of exponentials as products."""
    grown, half = math.expm1(time), 0.5 * omega * time
    sinh, bent = 0.5 * (grown + grown / (1 + grown)), 0.5 * grown * grown / (1 + grown)  # cosh - 1
    sway, spin = side * ripple * math.cos(psi), side * ripple * omega * math.sin(psi)
    pull = u - 1 - sway
    turned = -2 * side * ripple * math.sin(half)
    return (
        u + pull * bent + (v + spin) * sinh + turned * math.sin(psi + half),
        v + pull * sinh + (v + spin) * bent + turned * omega * math.cos(psi + half),
    )


@njit
def root(which, left, right, u, v, side, psi, omega, ripple):
    """Find the sign change of u (0) or u' (1) between two times, by secants and bisections in turn."""
    low = at(left, u, v, side, psi, omega, ripple)[which]
    high = at(right, u, v, side, psi, omega, ripple)[which]
    for turn in range(200):
        trial = (left * high - right * low) / (high - low) if turn % 3 < 2 else 0.5 * (left + right)
        if not left < trial < right:
            trial = 0.5 * (left + right)
        if not left < trial < right or right - left < 1e-15:
            break
        value = at(trial, u, v, side, psi, omega, ripple)[which]
        if (value > 0) == (low > 0):
            left, low = trial, value
        else:
            right, high = trial, value
    return right


@njit
def impact(time, u, v, side, psi, omega, ripple):
    """Return the time at which u first reaches zero, with two extrema at most before; infinite if it does not."""
    later, speed = at(time, u, v, side, psi, omega, ripple)
    begin = 0.0
    if later <= 0:
        if v > 0:
            begin = root(1, 0.0, time, u, v, side, psi, omega, ripple)
        return root(0, begin, time, u, v, side, psi, omega, ripple)
    if v < 0 < speed:
        lowest = root(1, 0.0, time, u, v, side, psi, omega, ripple)
        if at(lowest, u, v, side, psi, omega, ripple)[0] < 0:
            return root(0, 0.0, lowest, u, v, side, psi, omega, ripple)
    return math.inf


@njit
def march(amplitude, omega, restitution, cycles, rows, angle=0.0, velocity=0.0, phase=0.0):
    """Return the end of a run from ``angle`` and ``velocity`` at ψ = ``phase``; ``rows`` takes the ends of its last cycles."""
    ripple, turn = amplitude / (1 + omega**2), 2 * math.pi
    samples = math.ceil(DENSITY * max(1.0, turn / omega))
    step, lift = turn / samples, math.acos(1 / max(amplitude, 1.0))  # of ψ
    psi, side = phase, -1 if angle < 0 or (angle == 0 and velocity <= 0) else 1
    u, v, reach, lifted = side * angle, side * velocity, math.inf, False
    rests = angle == 0 and velocity == 0
    for cycle in range(cycles):
        sample = math.floor((psi - phase) / step) + 1
        while sample <= samples:
            if rests:
                if amplitude <= 1:
                    return AT_REST, rows
                half = math.ceil((psi - lift) / math.pi)  # it lifts off within ``lift`` of a multiple of π
                psi, v, side, lifted = max(half * math.pi - lift, psi), 0.0, 2 * (half % 2) - 1, True
                rests, sample = False, math.floor((psi - phase) / step) + 1
                continue
            wait = phase + sample * step - psi
            if lifted:  # nothing ends while the base throws it up; a shorter way drowns in rounding
                if wait < 0.25 * step:
                    sample += 1
                    continue
                hit, lifted, reach = math.inf, False, math.inf
            else:
                if u == 0:
                    reach = 0.1 * v / (1 + amplitude) * omega  # well inside the shortest arc
                wait = min(wait, reach)
                hit = impact(wait / omega, u, v, side, psi, omega, ripple)
            if hit == math.inf:
                u, v = at(wait / omega, u, v, side, psi, omega, ripple)
                psi += wait
                reach *= 2
                if psi >= phase + sample * step - 1e-14:
                    psi = phase + sample * step
                    sample += 1
                if u > 10 * (1 + ripple) and v > 0:
                    return OVERTURNED, rows
                continue
            v = -restitution * at(hit, u, v, side, psi, omega, ripple)[1]
            u, side, psi = 0.0, -side, psi + omega * hit
            rests = v < STILL and amplitude * abs(math.cos(psi)) < 1
        psi -= turn
        kept = cycle - (cycles - len(rows))
        if kept >= 0:
            rows[kept, 0], rows[kept, 1] = side * u, side * v
    return BOUNDED, rows
