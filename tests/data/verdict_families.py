"""Families of systems, from which cases of verdicts are drawn at random."""

import math

import numpy as np

RESTITUTIONS = (0.0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.925, 0.95, 0.97, 0.99)


def case(family, A, T, e, phi=0.0, start=(0.0, 0.0), brace=None, r=None, digits=4):
    """One system and start, rounded to what is printed."""
    return {
        "family": family,
        "A": round(float(A), digits),
        "T": round(float(T), digits),
        "e": float(e),
        "phi": round(float(phi), max(3, digits - 1)),
        "Theta0": round(float(start[0]), digits),
        "dTheta0": round(float(start[1]), digits),
        "brace": None if brace is None else float(brace),
        "r": None if r is None else float(r),
    }


def _log_uniform(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def _anywhere(rng, angle=0.9, velocity=1.0):
    return rng.uniform(-angle, angle), rng.uniform(-velocity, velocity)


def _phase(rng):
    return rng.uniform(0, 2 * math.pi) if rng.random() < 0.6 else 0.0


def _in_band(rng, period, low, high):
    """An amplitude with A/(1 + Ω²) in a band, 40 at most."""
    return min(40.0, rng.uniform(low, high) * (1 + (2 * math.pi / period) ** 2))


def _amplitude(rng, period):
    return _log_uniform(rng, 0.05, 40) if rng.random() < 0.5 else _in_band(rng, period, 0.05, 0.7)


def from_rest(rng):
    T = _log_uniform(rng, 0.1, 6)
    return case("from rest", _amplitude(rng, T), T, rng.choice(RESTITUTIONS), _phase(rng))


def any_restitution(rng):
    T = _log_uniform(rng, 0.1, 6)
    e = round(rng.uniform(0.2, 1), 4)
    return case("any restitution", _in_band(rng, T, 0.05, 0.6), T, e, _phase(rng), _anywhere(rng, 0.2, 0.3))


def from_anywhere(rng):
    T = _log_uniform(rng, 0.1, 6)
    return case("from anywhere", _amplitude(rng, T), T, rng.choice(RESTITUTIONS), _phase(rng), _anywhere(rng))


def subharmonic(rng):
    T = rng.uniform(0.2, 0.6)
    A = _log_uniform(rng, 2, 9) if T > 0.4 else _log_uniform(rng, 3, 15)
    return case("subharmonic", A, T, rng.choice((0.95, 0.96, 0.97, 0.98, 0.99)), _phase(rng), _anywhere(rng))


def coexisting(rng):
    return case("coexisting", 5.5, 0.5, 0.925, _phase(rng), _anywhere(rng))


def braced(rng):
    T, brace = _log_uniform(rng, 0.3, 6), round(_log_uniform(rng, 0.2, 2), 2)
    start = _anywhere(rng, 0.9 * min(brace, 1)) if rng.random() < 0.5 else (0.0, 0.0)
    r = rng.choice((0.0, 0.3, 0.5, 0.7, 0.9, 1.0))
    e = rng.choice((0.5, 0.7, 0.8, 0.9, 0.925, 0.95, 0.99))
    return case("braced", _log_uniform(rng, 0.5, 40), T, e, _phase(rng), start, brace, r)


def leaning(rng):
    brace = round(_log_uniform(rng, 0.1, 0.8), 2)
    A, e, r = _log_uniform(rng, 2, 25), rng.choice((0.5, 0.7, 0.8, 0.9)), rng.choice((0.0, 0.2, 0.4, 0.6))
    return case("leaning", A, _log_uniform(rng, 0.8, 5), e, _phase(rng), brace=brace, r=r)


def leaning_for_ever(rng):
    A, e, r = rng.uniform(0.05, 0.9), rng.choice((0.5, 0.8, 0.95)), rng.choice((0.0, 0.3, 0.6, 0.9))
    brace = round(1 + A + rng.uniform(0.02, 0.5), 2)
    start = (rng.uniform(0.6, brace) * rng.choice((-1, 1)), rng.uniform(-0.3, 0.9))
    return case("leaning for ever", A, _log_uniform(rng, 0.5, 4), e, _phase(rng), start, brace, r)


def chatter(rng):
    e = rng.choice((0.0, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.925, 0.95))
    return case("chatter", 1 + _log_uniform(rng, 0.002, 0.5), _log_uniform(rng, 0.1, 6), e, _phase(rng))


def below_one(rng):
    e = rng.choice((0.4, 0.6, 0.8, 0.9, 0.95, 0.97))
    return case(
        "below one", _log_uniform(rng, 0.05, 1), _log_uniform(rng, 0.3, 6), e, _phase(rng), _anywhere(rng)
    )


def slow_and_below_one(rng):
    e = rng.choice((0.9, 0.95, 0.97, 0.99, 1.0))
    return case("below one", rng.uniform(0.4, 1), rng.uniform(3, 6), e, _phase(rng), _anywhere(rng, 0.3, 0.3))


def between_doublings(rng):
    T = rng.uniform(0.3, 3)
    e = rng.choice((0.2, 0.3, 0.4, 0.5, 0.6))
    return case("between doublings", _in_band(rng, T, 0.37, 0.62), T, e, _phase(rng))


def lossless(rng):
    start = (rng.uniform(-0.1, 0.1), rng.uniform(-0.25, 0.25))
    return case("lossless", rng.uniform(0.3, 4.5), rng.uniform(0.2, 0.6), 1.0, start=start)


def lossless_between_braces(rng):
    start = (rng.uniform(-0.1, 0.1), rng.uniform(-0.2, 0.2))
    brace, r = round(rng.uniform(0.6, 2), 2), rng.choice((0.0, 0.4, 0.8))
    return case("lossless, braces", rng.uniform(0.3, 3), rng.uniform(0.2, 0.5), 1.0, 0.0, start, brace, r)


def bouncing_on_one_brace(rng):
    brace, e = round(rng.uniform(1.3, 1.7), 2), rng.choice((0.5, 0.8, 0.9))
    start = (1 + rng.uniform(0.4, 0.8) * (brace - 1), 0.0)
    A, T = rng.uniform(0.05, 0.2), _log_uniform(rng, 0.3, 1.5)
    return case("one brace", A, T, e, _phase(rng), start, brace, 1.0)


# family: how many are drawn, how many of a kind, period and symmetry are kept
FAMILIES = {
    from_rest: (110, 4),
    any_restitution: (60, 4),
    from_anywhere: (60, 4),
    subharmonic: (220, 3),
    coexisting: (60, 2),
    braced: (90, 7),
    leaning: (24, 4),
    leaning_for_ever: (14, 7),
    chatter: (44, 12),
    below_one: (24, 8),
    slow_and_below_one: (16, 4),
    between_doublings: (50, 6),
    lossless: (36, 9),
    lossless_between_braces: (10, 5),
    bouncing_on_one_brace: (40, 5),
}


def drawn(seed):
    """All families at random; the same seed gives the same cases."""
    for family, (count, most) in FAMILIES.items():
        rng = np.random.default_rng([seed, *family.__name__.encode()])
        for _ in range(count):
            yield family(rng), most
