"""Evaluation of the arc of each lane at one time: elementary functions, u and its derivatives, small steps."""

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose, circular, hyperbolic
from rocking.kernels.numerics.taylor import I2, I3, I4


@njit(**INTERNAL_INLINE)
def derivatives(s, i, there):
    """Return u and its first six derivatives at an instant (u, u', cos eta, sin eta) in lane i, from u'' = u + f."""
    u, v, cosine, sine = there
    square, acceleration = s.frequency_square[i], s.amplitude[i] * cosine
    df, ddf = s.amplitude_rate[i] * sine, square * acceleration
    c2, c3 = u - (1.0 + acceleration), v + df
    c4, c5 = c2 + ddf, fma(-square, df, c3)
    return u, v, c2, c3, c4, c5, fma(-square, ddf, c4)


@njit(**INTERNAL_INLINE)
def instant_of(s, i, above):
    """Evaluate the arc of lane i at its trial time, eq. (5); u0 = 1 + ``above``.

    The formulas are those of ``harmonic.forced_response`` and ``solution.propagate``.

    Returns
    -------
    tuple of (float, float, float, float)
        u - u0 and u'.
        cos eta and sin eta.
    """
    frequency, response = s.frequency[i], s.response[i]
    velocity, cosine, sine = s.velocity[i], s.cosine[i], s.sine[i]
    sinh, versinh, excess = s.sinh[i], s.versinh[i], s.excess[i]
    sin_x, versine, lag = s.sin_x[i], s.versine[i], s.lag[i]
    near = s.time[i] < s.short_time_limit[i]
    in_phase, quadrature = versinh + versine, fma(frequency, excess, lag)
    displacement = choose(near, -fma(s.frequency_square[i], s.higher[i], s.deficit[i]), in_phase)
    forced_velocity = choose(near, -frequency * quadrature, fma(frequency, sin_x, sinh))
    steady = choose(near, fma(-s.amplitude[i], cosine, above), above)
    response_cosine = response * cosine
    displaced = fma(response * sine, quadrature, -response_cosine * displacement)
    moved = fma(s.response_rate[i] * sine, in_phase, -response_cosine * forced_velocity)
    return (
        fma(velocity, sinh, fma(steady, versinh, displaced)),
        velocity + fma(velocity, versinh, fma(steady, sinh, moved)),
        cosine - fma(cosine, versine, sine * sin_x),
        sine - fma(sine, versine, -cosine * sin_x),
    )


@njit(**INTERNAL_INLINE)
def evaluate_hyperbolic(s, i):
    """Evaluate the hyperbolic functions of the trial time of lane i."""
    s.sinh[i], s.versinh[i], s.excess[i], s.higher[i] = hyperbolic(s.time[i])


@njit(**INTERNAL_INLINE)
def evaluate_circular(s, i):
    """Evaluate the circular functions of the trial time of lane i."""
    s.sin_x[i], s.versine[i], s.lag[i], s.deficit[i] = circular(s.frequency[i], s.time[i])


@njit(**INTERNAL_INLINE)
def set_next(s, i, x, cosine, sine):
    """Write the forcing and the hyperbolic functions a small time x after the trial time.

    The series are those of ``fast_path.taylor_step``.
    """
    sinh, versinh, angle = s.sinh[i], s.versinh[i], s.frequency[i] * x
    sin_x = angle * fma(-angle * angle, I3, 1.0)
    versine = angle * angle * fma(-angle * angle, I4, I2)
    sinh_x, versinh_x = x * fma(x * x, I3, 1.0), x * x * fma(x * x, I4, I2)
    s.next_cosine[i] = cosine - fma(cosine, versine, sine * sin_x)
    s.next_sine[i] = sine - fma(sine, versine, -cosine * sin_x)
    s.next_sinh[i] = sinh + fma(sinh, versinh_x, fma(versinh, sinh_x, sinh_x))
    s.next_versinh[i] = versinh + fma(versinh, versinh_x, fma(sinh, sinh_x, versinh_x))
