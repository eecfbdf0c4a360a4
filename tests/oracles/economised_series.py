"""Lanczos's economisation: short polynomials that are as accurate on a short range as long ones.

The last power of a polynomial is replaced by the other terms of the Chebyshev polynomial of its degree n, which is small
on the whole range. The error is the coefficient over 2**(2n - 1) times the range to the power n. Without the replacement
it would be 2**(2n - 1) times as large. Fractions give the same coefficients on every machine.
"""

from fractions import Fraction


def chebyshev(most):
    """The coefficients of the Chebyshev polynomials on [0, 1] up to a degree, by T[n+1](x) = 2 (2x - 1) T[n](x) - T[n-1](x)."""
    polynomials = [[1], [-1, 2]]
    for _ in range(most - 1):
        before, last = polynomials[-2:]
        turns = zip([0, *last], [*last, 0], [*before, 0, 0], strict=True)
        polynomials.append([4 * raised - 2 * same - earlier for raised, same, earlier in turns])
    return polynomials


def economised(coefficients, widest, terms):
    """Return ``terms`` coefficients, by increasing powers, of a polynomial nearly equal to a longer one on [0, ``widest``]."""
    width, polynomials = Fraction(widest), chebyshev(len(coefficients) - 1)
    left = [Fraction(c) * width**k for k, c in enumerate(coefficients)]
    while len(left) > terms:
        polynomial = polynomials[len(left) - 1]
        share = left.pop() / polynomial[-1]
        left = [c - share * other for c, other in zip(left, polynomial[:-1], strict=True)]
    return tuple(float(c / width**k) for k, c in enumerate(left))
