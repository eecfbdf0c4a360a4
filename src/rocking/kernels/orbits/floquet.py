"""Floquet multipliers of a periodic orbit, and a norm in which the orbit attracts.

The multipliers are the eigenvalues of the derivative of the return map. An orbit is stable if both lie inside
the unit circle.
"""

import math

from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics.elementary import fma, size


@entry_point
def eigenvalues(middle: float, square: float, determinant: float) -> tuple[float, float, float, float]:
    """Return both eigenvalues of a real matrix: the larger first, or the one above the real axis.

    ``middle`` is half its trace, ``square`` the square of half their difference. A caller that knows the
    whole matrix computes ``square`` without the cancellation of the formula in trace and determinant.

    Returns
    -------
    tuple of (float, float, float, float)
        Real and imaginary part of the first, then of the second.
    """
    if square < 0.0:
        root = math.sqrt(-square)
        return middle, root, middle, -root
    root = math.sqrt(square)
    large = middle + root if middle >= 0.0 else middle - root
    small = determinant / large if large != 0.0 else 0.0
    return large, 0.0, small, 0.0


@kernel
def multipliers(tangent):
    """Return the Floquet multipliers of an orbit, the ``eigenvalues`` of its tangent.

    The larger is first, or the one above the real axis.
    """
    apart, crossed = 0.5 * (tangent.a - tangent.d), tangent.b * tangent.c
    determinant = fma(tangent.a, tangent.d, -crossed)
    return eigenvalues(0.5 * (tangent.a + tangent.d), fma(apart, apart, crossed), determinant)


def complex_multipliers(middle, square, determinant, mirrored):
    """Return the Floquet multipliers of an orbit, two complex numbers; arguments as for ``eigenvalues``.

    If ``mirrored``, the map is over half a period, and they are the squares of its eigenvalues.
    """
    real, above, other, below = eigenvalues(middle, square, determinant)
    if mirrored:
        turned = 2.0 * abs(real * above)
        real, other = real * real - above * above, other * other - below * below
        above, below = (turned, -turned) if turned > 0.0 else (0.0, 0.0)
    return complex(real, above), complex(other, below)


@kernel
def adapted_norm(tangent, radius):
    """Return a norm in which a matrix with spectral radius < ``radius`` shrinks at least by the factor ``radius``.

    Q = sum over k < 2^j of N^kT N^k with N = M/radius, by doubling. In its norm no vector grows under N if the 2^j-th power
    of N enlarges no vector. No eigenvectors are needed, which coincide if the multipliers do.

    Returns
    -------
    tuple of (float, float, float)
        q11, q12 and q22.
    """
    q11, q12, q22 = 1.0, 0.0, 1.0
    # the columns of N are (a, b) and (c, d)
    a, b, c, d = tangent.a / radius, tangent.b / radius, tangent.c / radius, tangent.d / radius
    for _ in range(60):
        # Q N, then N^T of it
        t11, t12 = q11 * a + q12 * b, q11 * c + q12 * d
        t21, t22 = q12 * a + q22 * b, q12 * c + q22 * d
        q11, q12, q22 = q11 + a * t11 + b * t21, q12 + a * t12 + b * t22, q22 + c * t12 + d * t22
        a, b, c, d = a * a + c * b, b * a + d * b, a * c + c * d, b * c + d * d
        # then the power has a norm of at most 1
        if max(abs(a), abs(b), abs(c), abs(d)) <= 0.5:
            break
    return q11, q12, q22


@kernel
def length(norm, x, y):
    """Return the length of (x, y) in an adapted norm."""
    q11, q12, q22 = norm
    return math.sqrt(q11 * x * x + 2.0 * q12 * x * y + q22 * y * y)


@kernel
def spectral_radius(tangent):
    """Return the modulus of the largest multiplier."""
    real, imaginary, _, _ = multipliers(tangent)
    return size(real, imaginary)
