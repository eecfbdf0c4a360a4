"""Named cases: those of the paper, those at bifurcations by closed forms, and rare ones found in many random draws."""

import math

from data.verdict_families import case


def symmetric_mode(A, T, e, n):
    """Return (V, φ) just after an impact of the stable mode (1, n), eqs. (8)–(10)."""
    omega = 2 * math.pi / T
    beta, t = A / (1 + omega**2), math.tanh(n * math.pi / omega / 2)
    less, more = (1 - e) / (2 * e), (1 + e) / (2 * e)
    square, half, last = (
        omega**2 * t**2 * less**2 + more**2,
        t * more,
        t**2 - omega**2 * beta**2,
    )
    V = (half + math.sqrt(half**2 - square * last)) / square
    return V, math.atan2((t - V * more) / omega, -t * V * less)


def existence_amplitude(T, e, n):
    omega = 2 * math.pi / T
    t = math.tanh(n * math.pi / omega / 2)
    return (1 + omega**2) * t**2 * (1 - e) / math.sqrt((1 + e) ** 2 + (omega * t * (1 - e)) ** 2)


def symmetry_breaking_amplitude(T, e, n):
    omega = 2 * math.pi / T
    h = n * math.pi / omega
    t, S, C = math.tanh(h / 2), math.sinh(h), math.cosh(h)
    less, more = (1 - e) / (2 * e), (1 + e) / (2 * e)
    V = e * (1 + e) * S / (2 * e * C - (1 + e**2) + S * t * (1 - e) ** 2 * (1 + omega**2) / 2)
    return (1 + omega**2) * math.hypot(t * V * less, (t - V * more) / omega)


def near_bifurcations():
    """Within 0.1 % of folds and symmetry breakings, on both sides of these, and on modes whose impact lies at the section."""
    for T, e, n in (
        (1.0, 0.8, 1),
        (1.5, 0.925, 1),
        (2.0, 0.9, 1),
        (0.4, 0.925, 3),
        (0.5, 0.925, 3),
        (0.35, 0.95, 5),
    ):
        fold = existence_amplitude(T, e, n)
        for share in (1.0003, 1.0009, 1.02):
            V, phi = symmetric_mode(share * fold, T, e, n)
            yield case("fold", share * fold, T, e, phi, (0.0, V), digits=6)
    for T, e, n in ((1.0, 0.8, 1), (1.5, 0.8, 1), (1.5, 0.925, 1), (2.0, 0.925, 1), (0.4, 0.925, 3)):
        breaking = symmetry_breaking_amplitude(T, e, n)
        for share in (0.9992, 1.0005, 1.0009):
            V, phi = symmetric_mode(share * breaking, T, e, n)
            yield case("symmetry breaking", share * breaking, T, e, phi, (1e-4, V), digits=6)
    for A in (10.46, 10.4735, 10.48, 10.6, 10.7, 10.74, 10.05, 10.095):
        yield case("doubling", A, 1.721328, 0.8, digits=6)


def chosen():
    """The paper's cases and what is known by name."""
    yield case("paper", 2, 1, 0.925)
    yield case("paper", 6.5, 0.4, 0.925)
    yield case("paper", 5.5, 0.5, 0.925, 1.8, (0, 0.15))
    yield case("paper", 5.5, 0.5, 0.925, 1.8, (0.15, 0))
    yield case("paper", 1.75, 2, 0.95)
    yield case("paper", 4, 0.4, 1)
    yield case("paper", 2, 0.4, 1)
    yield case("paper", 15, 2, 0.925, brace=1, r=1)
    yield case("persistent chaos", 10.103037, 1.721328, 0.8, digits=6)
    yield case("persistent chaos", 13.556042, 1.531471, 0.8, digits=6)
    yield case("long transient", 4.86, 0.33, 0.99)
    yield case("crisis", 4.88, 0.33, 0.99)
    yield case("one brace", 0.1, 1, 0.9, 0, (1.3, 0), 1.5, 1)
    yield case("at rest", 0.5, 1, 0.9)
    yield case("at rest", 0.99, 2, 1)
    yield case("at rest", 0.98, 0.7, 0.6, 2.0, (0.2, -0.1))
    yield case("at rest", 0.9, 1.5, 0.0, 1.0, (0.3, 0.2))
    yield case("leaning for ever", 0.3, 1, 0.9, 0, (1.5, 0), 1.5, 0.5)
    yield case("leaning for ever", 1.2, 1.3, 0.8, 0.5, (2.0, 0.5), 2.4, 0.4)


# Found among 2,600 draws of `subharmonic` and 260 of `braced`: A, T, e, φ, start on the orbit; A, T, e, φ, start, brace, r
LONG_PERIODS = (
    (9.9749, 0.3485, 0.95, 0.0, (0.16346, 0.505865)),
    (4.6207, 0.5647, 0.96, 3.212, (-0.217968, -0.456798)),
    (3.3917, 0.4887, 0.99, 0.0, (0.21345, -0.142329)),
    (11.1122, 0.2907, 0.98, 3.3, (0.170869, 0.300785)),
    (12.5588, 0.3174, 0.97, 0.631, (-0.183295, -0.782192)),
    (8.7122, 0.4993, 0.98, 0.486, (0.243063, 0.166173)),
    (3.1784, 0.402, 0.99, 1.931, (-0.009045, -0.965567)),
    (2.4693, 0.4415, 0.99, 5.176, (0.55264, 0.157607)),
    (12.1445, 0.2397, 0.99, 0.0, (0.220258, -0.429255)),
    (5.0944, 0.4266, 0.99, 1.507, (0.279962, -0.275259)),
    (4.16, 0.5127, 0.97, 0.0, (0.214715, 0.572849)),
    (8.7035, 0.2238, 0.99, 5.695, (0.180329, -0.219854)),
    (4.9237, 0.4303, 0.98, 0.557, (-0.161079, -0.106704)),
)
EVEN_PERIODS = (
    (14.2342, 1.3676, 0.8, 0.135, (-0.274, 0.8707), 0.52, 0.5),
    (13.7694, 1.1345, 0.8, 4.511, (-0.2705, -0.6341), 0.39, 0.9),
    (3.6, 2.0085, 0.9, 3.012, (0, 0), 0.3, 0.5),
    (35.3079, 0.3733, 0.9, 1.961, (0, 0), 0.29, 0.0),
    (1.1465, 2.072, 0.5, 0.0, (-0.0139, 0.2427), 0.3, 0.7),
    (10.6391, 5.0888, 0.925, 4.723, (0, 0), 0.49, 0.7),
    (4.0555, 3.0027, 0.95, 4.155, (0, 0), 0.93, 0.7),
    (1.6019, 3.9912, 0.95, 4.389, (0, 0), 0.24, 0.7),
    (18.0631, 0.841, 0.5, 5.071, (0, 0), 1.42, 0.0),
)


def found():
    """Long periods from starts on their orbits, even periods with braces, and chattering that is almost undamped."""
    for numbers in LONG_PERIODS:
        yield case("on its orbit", *numbers, digits=6)
    for numbers in EVEN_PERIODS:
        yield case("braced, even", *numbers)
    for A, T, e in (
        (1.004, 2.5, 0.97),
        (1.003, 1.1, 0.9),
        (1.005, 3.7, 0.8),
        (1.15, 0.9, 0.2),
        (1.3, 2.2, 0.1),
    ):
        yield case("chatter", A, T, e, 0.4)
