"""Periodic orbits of the slender block, proved in interval arithmetic.

Nothing is taken from the package. An orbit is a chain of events; the unknowns are their forcing phases.
On side s = +1 or -1 the angle u = s Theta >= 0 obeys u'' = u - 1 - s A cos psi, where psi' = Omega.
With f = s A / (1 + Omega^2), the motion of an arc is u = 1 + f cos psi + w, where w'' = w.
The position at both ends of an arc is known: 0 at an impact and B at a brace.
The phases therefore give w at both ends, and these values give w' there.
At an event, u' after it is -e or -r times u' before it, each on the side of its own arc.
These are as many equations as phases. Krawczyk's test proves that they have exactly one solution in a box.
"""

from contextlib import contextmanager
from typing import NamedTuple

from mpmath import iv, mp

DIGITS = 40
RADIUS = 1e-12
"""Smallest half width of the box in which the solution is unique, in radians of forcing phase."""
RADII = 4.0
"""Half width of the box, in radii of the phase that is given."""
ITERATIONS = 5
"""Newton steps from the middles to a point near the solution; their Jacobian is computed once."""
NARROWEST = 2.0**-40
"""Part of half an arc below which a piece counts as not clear."""


class Orbit(NamedTuple):
    """A chain of events. Give the period or the frequency of the base motion, and None for the other."""

    amplitude: float
    restitution: float
    period: float | None
    frequency: float | None
    brace: tuple | None
    """Angle B and coefficient of restitution r of the braces."""
    kinds: tuple
    """`impact` or `brace`, one per event."""
    side: int
    """Side after the first event."""
    half_turns: int
    """The chain repeats after this many times pi of forcing phase."""
    mirrored: bool
    """True if the repetition is the mirror image."""
    phases: tuple
    """Middle and radius of the forcing phase of each event."""


@contextmanager
def precision():
    """Compute with DIGITS decimal digits."""
    before = iv.prec, mp.prec
    iv.dps = mp.dps = DIGITS
    try:
        yield
    finally:
        iv.prec, mp.prec = before


def verified(orbit):
    """Return whether a box around the given phases is proved to hold exactly one solution.

    The box contains the given balls. Its half widths are RADII times the radii, but at least RADIUS.
    The signs of the speeds and the motion between the events are left to `stays_clear`.
    """
    with precision():
        return enclosure(orbit) is not None


def contains_solution(orbit):
    """Return whether the solution is proved to lie in the given balls, which are smaller than the box."""
    with precision():
        found = enclosure(orbit)
        if found is None:
            return False
        return all(within(phase, ball) for phase, ball in zip(found, balls_of(orbit), strict=True))


def stays_clear(orbit):
    """Return whether u > 0, and u < B with braces, is proved strictly between the events.

    The signs of u' are proved too: down before an impact, up before a brace, and the reverse after each.
    """
    with precision():
        phases = enclosure(orbit)
        if phases is None:
            return False
        chain = Chain(iv, orbit)
        limit = None if orbit.brace is None else iv.mpf(orbit.brace[0])
        for number in range(chain.size):
            length = (chain.length(phases, number) / 2).b
            halves = halves_of(chain, phases, number)
            if not all(has_sign(half) and is_clear(half, length, limit) for half in halves):
                return False
        return True


def trace_and_determinant(orbit):
    """Return bounds (low, high) of the trace and the determinant of a chain's derivative, or None.

    The state is (u, u') on the side of its arc. The chain of a mirrored orbit is half of its period.
    """
    with precision():
        phases = enclosure(orbit)
        if phases is None:
            return None
        chain = Chain(iv, orbit)
        product, determinant = ((iv.mpf(1), iv.mpf(0)), (iv.mpf(0), iv.mpf(1))), iv.mpf(1)
        for number in range(chain.size):
            product = times(arc_matrix(chain, phases, number), product)
            product = times(saltation(chain, phases, number), product)
            determinant *= chain.laws[chain.after(number)] ** 2
        trace = product[0][0] + product[1][1]
        return bounds(trace), bounds(determinant)


class Arc(NamedTuple):
    """Speeds u' at both ends of an arc, and their derivatives with respect to its first and last phase."""

    leaving: object
    arriving: object
    leaving_by: tuple
    arriving_by: tuple


class Chain:
    """The equations of an orbit, with the numbers of a context: `mp` for points or `iv` for intervals."""

    def __init__(self, context, orbit):
        self.context, self.size = context, len(orbit.kinds)
        self.amplitude = context.mpf(orbit.amplitude)
        if orbit.period is None:
            self.frequency = context.mpf(orbit.frequency)
        else:
            self.frequency = 2 * context.pi / context.mpf(orbit.period)
        self.response = self.amplitude / (1 + self.frequency**2)
        self.shift = int(orbit.half_turns) * context.pi
        position, law = {"impact": 0}, {"impact": orbit.restitution}
        if orbit.brace is not None:
            position["brace"], law["brace"] = orbit.brace
        self.positions = [context.mpf(position[kind]) for kind in orbit.kinds]
        self.laws = [context.mpf(law[kind]) for kind in orbit.kinds]
        self.sides = sides_of(orbit)

    def after(self, number):
        """Return the number of the event that ends an arc."""
        return (number + 1) % self.size

    def ends(self, phases, number):
        """Return the first and the last phase of an arc."""
        after = self.after(number)
        return phases[number], phases[after] if after else phases[after] + self.shift

    def length(self, phases, number):
        """Return the duration of an arc."""
        start, end = self.ends(phases, number)
        return (end - start) / self.frequency

    def acceleration(self, phase, number, position):
        """Return u'' at a phase and a position of an arc."""
        return position - 1 - self.sides[number] * self.amplitude * self.context.cos(phase)

    def arc(self, phases, number):
        """Return an arc: w = w0 cosh t + w0' sinh t gives w0' and w1' from w0 and w1."""
        context, frequency = self.context, self.frequency
        start, end = self.ends(phases, number)
        growth = context.exp((end - start) / frequency)
        cosh, sinh = (growth + 1 / growth) / 2, (growth - 1 / growth) / 2
        force = self.sides[number] * self.response
        cosine, sine = force * context.cos(start), force * context.sin(start)
        last_cosine, last_sine = force * context.cos(end), force * context.sin(end)
        first = self.positions[number] - 1 - cosine
        last = self.positions[self.after(number)] - 1 - last_cosine
        leaving, arriving = (last - first * cosh) / sinh, (last * cosh - first) / sinh
        # At fixed w0 and w1, the duration changes w0' at the rate -w1'/sinh and w1' at the rate -w0'/sinh.
        by_length, last_by_length = arriving / (sinh * frequency), leaving / (sinh * frequency)
        coth = cosh / sinh
        return Arc(
            leaving - frequency * sine,
            arriving - frequency * last_sine,
            (by_length - frequency * cosine - coth * sine, last_sine / sinh - by_length),
            (last_by_length - sine / sinh, coth * last_sine - frequency * last_cosine - last_by_length),
        )

    def equations(self, phases):
        """Return the values of the equations and their derivatives by (event, phase); all others are 0."""
        values, slopes = [self.context.mpf(0)] * self.size, {}
        for number in range(self.size):
            after, arc = self.after(number), self.arc(phases, number)
            values[number] += arc.leaving
            values[after] += self.laws[after] * arc.arriving
            for k, phase in enumerate((number, after)):
                slopes[number, phase] = slopes.get((number, phase), 0) + arc.leaving_by[k]
                slopes[after, phase] = slopes.get((after, phase), 0) + self.laws[after] * arc.arriving_by[k]
        return values, slopes


def sides_of(orbit):
    """Return the side of each arc, and that of the arc after the last event."""
    sides = [int(orbit.side)]
    for kind in (*orbit.kinds[1:], orbit.kinds[0]):
        sides.append(-sides[-1] if kind == "impact" else sides[-1])
    return sides


def is_consistent(orbit):
    """Return whether the events are possible, and whether sides and forcing repeat as the orbit says."""
    known = ("impact",) if orbit.brace is None else ("impact", "brace")
    if not orbit.kinds or len(orbit.kinds) != len(orbit.phases) or not set(known).issuperset(orbit.kinds):
        return False
    if orbit.brace is not None and not orbit.brace[0] > 0:
        return False
    if orbit.side not in (1, -1) or (orbit.period is None) == (orbit.frequency is None):
        return False
    flipped = sides_of(orbit)[-1] != orbit.side
    return flipped == orbit.mirrored and orbit.half_turns % 2 == int(orbit.mirrored)


def balls_of(orbit):
    """Return the given phases as intervals."""
    return [iv.mpf(middle) + iv.mpf(radius) * iv.mpf([-1, 1]) for middle, radius in orbit.phases]


def within(first, second):
    """Return whether an interval lies in another."""
    return bool(second.a <= first.a and first.b <= second.b)


def is_positive(number):
    """Return whether all of an interval is positive."""
    return bool(number.a > 0)


def inside(first, second):
    """Return whether an interval lies in the interior of another."""
    return bool(second.a < first.a and first.b < second.b)


def hull(first, second):
    """Return the smallest interval that holds two others."""
    return iv.mpf([min(first.a, second.a), max(first.b, second.b)])


def enclosure(orbit):
    """Return narrow intervals of the phases of the only solution in the box, or None if not proved."""
    if not is_consistent(orbit):
        return None
    radii = [max(RADIUS, RADII * radius) for _, radius in orbit.phases]
    found = near_solution(orbit, radii)
    if found is None:
        return None
    points, inverse = found
    chain, box = Chain(iv, orbit), [iv.mpf([p - w, p + w]) for p, w in zip(points, radii, strict=True)]
    if not all(map(within, balls_of(orbit), box)):
        return None
    if not all(is_positive(chain.length(box, number)) for number in range(chain.size)):
        return None
    image = contracted(chain, inverse, points, box)
    if not all(map(inside, image, box)):
        return None
    # The test again, on a smaller box that holds the solution and the points, gives narrower intervals.
    smaller = [hull(part, iv.mpf(point)) for part, point in zip(image, points, strict=True)]
    return contracted(chain, inverse, points, smaller)


def near_solution(orbit, radii):
    """Return a point near the solution, unproved, and the inverse of the Jacobian at the middles, or None."""
    chain, middles = Chain(mp, orbit), [mp.mpf(middle) for middle, _ in orbit.phases]
    try:
        jacobian = mp.matrix(chain.size, chain.size)
        for place, slope in chain.equations(middles)[1].items():
            jacobian[place] = slope
        inverse, points = mp.inverse(jacobian), middles
        for _ in range(ITERATIONS):
            steps = inverse * mp.matrix(chain.equations(points)[0])
            points = [point - step for point, step in zip(points, steps, strict=True)]
            if any(abs(p - m) > w for p, m, w in zip(points, middles, radii, strict=True)):
                return None
    except ZeroDivisionError:  # the Jacobian is singular, or an arc has no duration
        return None
    return points, inverse


def contracted(chain, inverse, points, box):
    """Return Krawczyk's image of a box: p - Y f(p) + (1 - Y f'(box)) (box - p)."""
    points = [iv.mpf(point) for point in points]
    values, slopes = chain.equations(points)[0], chain.equations(box)[1]
    offsets, image = [part - point for part, point in zip(box, points, strict=True)], []
    for row, point in enumerate(points):
        weights = [iv.mpf(inverse[row, column]) for column in range(chain.size)]
        rest = [iv.mpf(int(row == column)) for column in range(chain.size)]
        for (event, phase), slope in slopes.items():
            rest[phase] -= weights[event] * slope
        image.append(point - dot(weights, values) + dot(rest, offsets))
    return image


def dot(first, second):
    """Return the sum of the products."""
    return sum((a * b for a, b in zip(first, second, strict=True)), iv.mpf(0))


def times(first, second):
    """Return the product of two matrices."""
    columns = tuple(zip(*second, strict=True))
    return tuple(tuple(dot(row, column) for column in columns) for row in first)


def bounds(number):
    """Return the ends of an interval."""
    return mp.mpf(number.a), mp.mpf(number.b)


def arc_matrix(chain, phases, number):
    """Return the derivative of the state at the end of an arc with respect to that at its start."""
    growth = iv.exp(chain.length(phases, number))
    cosh, sinh = (growth + 1 / growth) / 2, (growth - 1 / growth) / 2
    return (cosh, sinh), (sinh, cosh)


def saltation(chain, phases, number):
    """Return the derivative of the state after the last event of an arc by the state before it."""
    after = chain.after(number)
    law, position = chain.laws[after], chain.positions[after]
    before = chain.acceleration(chain.ends(phases, number)[1], number, position)
    then = chain.acceleration(phases[after], after, position)
    return (-law, iv.mpf(0)), ((then + law * before) / chain.arc(phases, number).arriving, -law)


class Half(NamedTuple):
    """Half of an arc, at a time q from its end: u = 1 + force cos(phase + turn q) + rise e^q + fall e^-q."""

    position: object
    speed: object
    """du/dq at the end, q = 0."""
    force: object
    phase: object
    turn: object
    """Frequency, negative for the half that is followed backwards."""
    rise: object
    fall: object

    def values(self, q):
        """Return u, du/dq and the second derivative."""
        growth, angle = iv.exp(q), self.phase + self.turn * q
        cosine, sine = self.force * iv.cos(angle), self.force * iv.sin(angle)
        rise, fall = self.rise * growth, self.fall / growth
        return 1 + cosine + rise + fall, rise - fall - self.turn * sine, rise + fall - self.turn**2 * cosine

    def over(self, low, high):
        """Return an enclosure of u on a piece, and of du/dq if it begins at the end of the arc, else None."""
        whole = iv.mpf([low, high])
        bend = self.values(whole)[2]
        if low == 0:
            rate = self.speed + whole * bend
            return self.position + whole * rate, rate
        # whole - middle holds the true offsets, also where the middle is rounded.
        middle = whole.mid
        offset, (value, rate, _) = whole - middle, self.values(middle)
        return value + offset * rate + offset**2 * bend / 2, None


def halves_of(chain, phases, number):
    """Return an arc from its start forwards and from its end backwards."""
    arc, force = chain.arc(phases, number), chain.sides[number] * chain.response
    start, end = chain.ends(phases, number)
    position, last = chain.positions[number], chain.positions[chain.after(number)]
    return (
        half_of(position, arc.leaving, force, start, chain.frequency),
        half_of(last, -arc.arriving, force, end, -chain.frequency),
    )


def half_of(position, speed, force, phase, turn):
    """Return the half of an arc with a position and a speed du/dq at its end."""
    w, rate = position - 1 - force * iv.cos(phase), speed + force * turn * iv.sin(phase)
    return Half(position, speed, force, phase, turn, (w + rate) / 2, (w - rate) / 2)


def has_sign(half):
    """Return whether the speed at the end points into the arc: up at an impact, down at a brace."""
    return is_positive(half.speed if half.position == 0 else -half.speed)


def is_clear(half, length, limit):
    """Return whether u lies strictly between 0 and a limit for 0 < q <= length, by bisection."""
    pieces = [(mp.mpf(0), mp.mpf(length))]
    shortest = NARROWEST * pieces[0][1]
    while pieces:
        low, high = pieces.pop()
        value, rate = half.over(low, high)
        # An end of the arc itself lies on 0 or on the limit; a rate of one sign leads away from it.
        room = iv.mpf(1) if limit is None else limit - value
        above, below = is_positive(value), is_positive(room)
        if rate is not None and half.position == 0:
            above = is_positive(rate)
        elif rate is not None:
            below = is_positive(-rate)
        if above and below:
            continue
        if high - low < shortest or is_positive(-value) or is_positive(-room):
            return False
        middle = (low + high) / 2
        pieces += [(middle, high), (low, middle)]
    return True
