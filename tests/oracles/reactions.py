"""Extremes of the base reactions along a motion, by Taylor series between its events and a dense scan of each.

Nothing is taken from the package, except the events of the motion: time, kind, angle, velocity before and after. With
w = critical angle - |theta|, side s and the base acceleration a in units of g, w'' = w + s a for the slender block and
w'' = sin w + s a cos w for the full one. The centre of mass gives

    H/Mg = a + s (sin w w'^2 - cos w w'')/k,    N/Mg = 1 - (sin w w'' + cos w w'^2)/k,    k = Io/MR^2.
"""

from typing import NamedTuple

import numpy as np

ORDER = 20
PIECES_PER_SCALE = 16
COARSE, LEVELS = 41, 3
SHORTEST = 1e-12
# Length of a piece that counts as longer than the rounding of times.


class Cosine(NamedTuple):
    """Base acceleration A cos(frequency t + phase), up to a time, in units of g times the critical angle."""

    amplitude: float
    frequency: float
    phase: float
    until: float = np.inf

    @property
    def scale(self):
        """Time in which it varies."""
        return min(1.0, 2 * np.pi / self.frequency)

    @property
    def corners(self):
        """Times at which it jumps."""
        return np.array([self.until]) if self.until < np.inf else np.empty(0)

    def series(self, begins, ends):
        """Taylor coefficients (ORDER, n) at the start of each piece."""
        turn, found = self.frequency * begins + self.phase, []
        factor = np.where(begins + ends < 2 * self.until, self.amplitude, 0.0)
        for k in range(ORDER):
            found.append(factor * np.cos(turn + k * np.pi / 2))
            factor = factor * self.frequency / (k + 1)
        return np.array(found)


class Lines(NamedTuple):
    """Base acceleration that is linear between samples and 0 after the last."""

    values: np.ndarray
    step: float
    scale: float = 1.0

    @property
    def corners(self):
        """Times of the samples."""
        return np.arange(len(self.values)) * self.step

    def series(self, begins, ends):
        """Taylor coefficients (ORDER, n) at the start of each piece."""
        place = np.floor((begins + ends) / 2 / self.step).astype(int)
        inside = place < len(self.values) - 1
        place = np.minimum(place, len(self.values) - 2)
        slope = (self.values[place + 1] - self.values[place]) / self.step
        found = np.zeros((ORDER, len(begins)))
        found[0] = np.where(inside, self.values[place] + slope * (begins - place * self.step), 0.0)
        found[1] = np.where(inside, slope, 0.0)
        return found


class Rocking(NamedTuple):
    """Block: critical angle, k, equation of motion, rows (speed, restitution)."""

    critical_angle: float
    inertia: float
    full: bool
    law: tuple


class Found(NamedTuple):
    """Largest |H|/N in motion and at rest, ratio of the impulses of an impact, least N, and largest |theta| in rad."""

    moving: float
    resting: float
    impact: float
    reaction: float
    angle: float

    @property
    def friction(self):
        """Least coefficient of friction without sliding."""
        return np.inf if self.reaction <= 0 else max(self.moving, self.resting, self.impact)


class Piece(NamedTuple):
    """Polynomials of many pieces: coefficients (ORDER + 1, n) of w and (ORDER, n) of a, with sides, lengths and starts (n,)."""

    w: np.ndarray
    a: np.ndarray
    side: np.ndarray
    length: np.ndarray
    begin: np.ndarray

    def chosen(self, which):
        """Select pieces."""
        return Piece(*(each[..., which] for each in self))


def jets(block, w, rate, side, a):
    """Taylor coefficients of w."""
    c = [w, rate]
    sine, cosine = [np.sin(w)], [np.cos(w)]
    for k in range(ORDER - 1):
        if k:
            weights = [j * c[j] for j in range(1, k + 1)]
            sine.append(sum(x * cosine[k - j] for j, x in enumerate(weights, 1)) / k)
            cosine.append(-sum(x * sine[k - j] for j, x in enumerate(weights, 1)) / k)
        bend = c[k] + side * a[k]
        if block.full:
            bend = sine[k] + side * sum(a[j] * cosine[k - j] for j in range(k + 1))
        c.append(bend / ((k + 1) * (k + 2)))
    return np.array(c)


def value(c, x):
    """Polynomials (m, n) at times (n, points)."""
    total = np.zeros_like(x)
    for one in c[::-1]:
        total = total * x + one[:, None]
    return total


def pieces(block, base, begins, ends, side, w, rate):
    """Follow all arcs at once, piece by piece, to their ends. At rest (all sides 0) only the base acceleration is followed."""
    corners, longest, found = np.append(base.corners, np.inf), base.scale / PIECES_PER_SCALE, []
    while begins.size:
        later = corners[np.searchsorted(corners, begins * (1 + 1e-15), side="right")]
        stops = np.minimum(np.minimum(begins + longest, later), ends)
        a = block.critical_angle * base.series(begins, stops)
        c = jets(block, w, rate, side, a) if side.any() else np.zeros((ORDER + 1, len(a[0])))
        found.append(Piece(c, a, side, stops - begins, begins))
        step = (stops - begins)[:, None]
        slopes = c[1:] * np.arange(1, ORDER + 1)[:, None]
        w, rate = value(c, step)[:, 0], value(slopes, step)[:, 0]
        on = stops < ends
        begins, ends, side, w, rate = stops[on], ends[on], side[on], w[on], rate[on]
    whole = Piece(*(np.concatenate(parts, axis=-1) for parts in zip(*found, strict=True)))
    return [whole.chosen(whole.length > SHORTEST)]


def reactions(block, piece, x):
    """Return H/Mg, N/Mg and |theta| at times (n, points) since the start of each piece."""
    w, a, side = value(piece.w, x), value(piece.a, x), piece.side[:, None]
    rate = value(piece.w[1:] * np.arange(1, ORDER + 1)[:, None], x)
    bend = np.sin(w) + side * a * np.cos(w) if block.full else w + side * a
    across = a + side * (np.sin(w) * rate**2 - np.cos(w) * bend) / block.inertia
    up = 1 - (np.sin(w) * bend + np.cos(w) * rate**2) / block.inertia
    return across, up, np.abs(block.critical_angle - w)


def greatest(measure, piece):
    """Greatest value of measure(piece, x) over all pieces: a scan, then finer ones beside each maximum near the best."""
    places = np.linspace(0, 1, COARSE)
    coarse = measure(piece, piece.length[:, None] * places)
    padded = np.pad(coarse, ((0, 0), (1, 1)), constant_values=-np.inf)
    tops = (padded[:, 1:-1] >= padded[:, :-2]) & (padded[:, 1:-1] >= padded[:, 2:])
    best = coarse.max()
    which, index = np.nonzero(tops & (coarse >= best - 0.02 * max(1, abs(best))))
    near = piece.chosen(which)
    low, high = places[np.maximum(index - 1, 0)], places[np.minimum(index + 1, COARSE - 1)]
    for _ in range(LEVELS):
        x = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, COARSE)
        found = measure(near, near.length[:, None] * x)
        best, top, row = max(best, found.max()), found.argmax(axis=1), np.arange(which.size)
        low, high = x[row, np.maximum(top - 1, 0)], x[row, np.minimum(top + 1, COARSE - 1)]
    return best


class Followed(NamedTuple):
    """Pieces of a motion in motion and at rest, impacts (time, restitution), and the events with the start."""

    moving: list
    resting: list
    impacts: list
    rows: list


def followed(block, base, start, events, until):
    """Follow a motion up to a time. ``start`` is (Theta, Theta'), events are rows (time, kind, Theta, before, after)."""
    level = np.tan(block.critical_angle) / block.critical_angle if block.full else 1.0
    first = base.series(np.zeros(1), np.full(1, 1e-9))[0, 0]
    kind = "rest" if start == (0, 0) and abs(first) <= level else "lift-off"
    begun = [] if events and events[0][0] == 0 else [(0.0, kind, start[0], 0.0, start[1])]
    rows = [row for row in [*begun, *events] if row[0] < until]
    ends = [*(row[0] for row in rows[1:]), until][: len(rows)]
    arcs, still = [], []
    for (time, kind, angle, _, after), end in zip(rows, ends, strict=True):
        if kind == "rest":
            still.append((time, end))
        elif kind != "lean" and end > time:
            soon = base.series(np.array([time]), np.array([time + 1e-9]))[0, 0]
            side = np.sign(angle) or np.sign(after) or -np.sign(soon)
            w = block.critical_angle * (1 - side * angle)
            arcs.append((time, end, side, w, -block.critical_angle * side * after))
    moving = pieces(block, base, *np.array(arcs).T) if arcs else []
    resting = []
    if still:
        begins, stops = np.array(still).T
        zero = np.zeros(begins.size)
        resting = pieces(block, base, begins, stops, zero, zero, zero)
    speeds, kept = np.array(block.law).T
    hits = [
        (row[0], np.interp(abs(row[3]), speeds, kept))
        for row in events
        if row[1] == "impact" and row[0] <= until
    ]
    return Followed(moving, resting, hits, [*begun, *rows])


def impulse_ratio(block, e):
    """|J_x|/J_y of an impact."""
    return (1 - e) / ((1 + e) * np.tan(block.critical_angle))


def extremes(block, motion):
    """Return the extremes of a followed motion."""
    moving, resting, impacts, rows = motion
    e = min((e for _, e in impacts), default=1.0)
    least = [-greatest(lambda p, x: -reactions(block, p, x)[1], p) for p in moving]
    reaction = min([1.0] * bool(resting) + least, default=np.inf)
    slides = [0.0] if reaction <= 0 else [greatest(lambda p, x: ratio(block, p, x), p) for p in moving]
    return Found(
        moving=max(slides, default=0.0),
        resting=max((greatest(lambda p, x: np.abs(value(p.a, x)), p) for p in resting), default=0.0),
        impact=impulse_ratio(block, e),
        reaction=reaction,
        angle=max(
            [block.critical_angle * max(abs(row[2]) for row in rows)]
            + [greatest(lambda p, x: reactions(block, p, x)[2], p) for p in moving]
        ),
    )


def first_slip(block, motion, friction, step):
    """Return the first time at which |H| > friction N, from samples a step apart and bisection between two of them."""

    def lacks(piece, x):
        if piece.side[0] == 0:
            return np.abs(value(piece.a, x)) - friction
        across, up, _ = reactions(block, piece, x)
        return np.abs(across) - friction * up

    hits = [time for time, e in motion.impacts if impulse_ratio(block, e) > friction]
    found = min(hits, default=np.inf)
    for many in [*motion.moving, *motion.resting]:
        for index in np.argsort(many.begin, kind="stable"):
            piece = many.chosen([index])
            begin, length = piece.begin[0], piece.length[0]
            if begin >= found:
                break
            x = np.append(np.arange(0, length, step), length)
            over = np.flatnonzero(lacks(piece, x[None])[0] > 0)
            if not over.size:
                continue
            high = x[over[0]]
            low = x[over[0] - 1] if over[0] else high
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (low, middle) if lacks(piece, np.array([[middle]]))[0, 0] > 0 else (middle, high)
            found = min(found, begin + high)
            break
    return found


def ratio(block, piece, x):
    """|H|/N."""
    across, up, _ = reactions(block, piece, x)
    return np.abs(across) / up
