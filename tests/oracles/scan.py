"""Next event of an arc, sample by sample: sign changes are bracketed, dips between samples are examined."""

from flint import arb, ctx


def _root(function, left, right):
    """Bracketed zero: bisection and secant in turn (Illinois), to the last digit."""
    low, high = function(left), function(right)
    sign = low > 0
    tiny = right * arb(2) ** (30 - ctx.prec)
    for _ in range(2000):
        trial = ((left * high - right * low) / (high - low)).mid()
        if not (left < trial < right):
            trial = ((left + right) / 2).mid()
        value = function(trial).mid()
        if value == 0 or right - left < tiny:
            return trial
        if (value > 0) == sign:
            moved, left, low, high = trial - left, trial, value, high / 2
        else:
            moved, right, high, low = right - trial, trial, value, low / 2
        if abs(moved) < tiny and abs(value) < tiny:
            return trial
    raise ArithmeticError("no convergence")


def _zero_between(height, slope, left, right):
    """Find the first zero, up to right, of a height that is positive at left; None if there is none. Dips are examined."""
    if height(right) < 0:
        if slope(left) > 0:  # it rises first, so the zero lies beyond a top
            left = _root(slope, left, right)
        return _root(height, left, right)
    if slope(left) < 0 and slope(right) > 0:
        lowest = _root(slope, left, right)
        if height(lowest) < 0:
            return _root(height, left, lowest)
    return None


def next_event(block, motion, side, growing):
    """Return (time, kind) of the next event of an arc, (None, None) if the run ends or the block overturns first."""
    left, step, rest = arb(0), block.step_start(), block.end - block.now
    gaps = {"impact": (lambda t: side * motion(t)[0], lambda t: side * motion(t)[1])}
    if block.brace is not None:
        gaps["brace"] = (lambda t: block.brace - side * motion(t)[0], lambda t: -side * motion(t)[1])
    while left < rest:
        right = min(left + step, rest).mid()
        found = [(_zero_between(*gap, left, right), kind) for kind, gap in gaps.items()]
        found = [hit for hit in found if hit[0] is not None]
        if found:
            return min(found, key=lambda hit: float(hit[0]))
        if block.brace is None and growing > 0 and growing * right.exp() > 10 + 10 * block.ripple:
            block.overturned = True
            return None, None
        left, step = right, min(step * block.rate, block.coarsest)
    return None, None
