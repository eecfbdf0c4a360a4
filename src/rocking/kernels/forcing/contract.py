"""Functions that every forcing provides. The type of ``p``, the parameters of a system, chooses the body at compile time.

March, impact law, tangent vectors and recording know a forcing through these functions alone. The package of the forcing
provides them (``harmonic.bodies``). It alone reads the ``drive`` of an arc, of an instant and of an event, the
``constants`` of an arc, and the guess of ``guess_from``.
"""

from rocking.kernels.deferred import contract


@contract
def arc_at(p, side, cycle, start, angle, velocity):
    """Return the arc that starts at (u, u') = (angle, velocity) on ``side``, at a time of the clock."""


@contract
def arc_renewed(p, side, start, angle, velocity, coming):
    """Return the arc that starts with the event ``coming``, the forcing computed as accurately as possible."""


@contract
def arc_after(p, side, start, angle, velocity, coming):
    """Return the arc that starts with the event ``coming``, the forcing taken from it."""


@contract
def resynchronise(p, arc):
    """Return the arc with its forcing computed from the clock, which removes rounding errors of ``arc_after``."""


@contract
def evaluate(p, arc, t):
    """Return the ``Instant`` of an arc at a time t >= 0 after its start."""


@contract
def forcing_term(p, side, drive):
    """Return f = u'' - u on a side of the base: -1 - side * base acceleration."""


@contract
def acceleration(p, side, angle, drive):
    """Return u'' at an angle on a side of the base."""


@contract
def restoring_acceleration(p):
    """Return -u'' at the base without base motion."""


@contract
def restitution_at(p, speed):
    """Return the coefficient of restitution at a speed before an impact, and the derivative of the speed after it."""


@contract
def transfer(p, arc, start, time):
    """Return the ``Transfer`` along an arc, from a time after its start over another time."""


@contract
def transfer_to_event(p, arc, coming):
    """Return the ``Transfer`` along a whole arc, to the event that ends it."""


@contract
def guess_from(p, wait):
    """Return the guess of the next event from the time until it; 0 if unknown."""


@contract
def next_event(p, mode, arc, guess):
    """Find the next event of an arc, a rest or a contact with a brace, certified.

    A ``wait`` that is infinite proves that no event follows. NONE after a finite time only restarts an arc.

    Returns
    -------
    tuple of (Next, guess)
        The next event.
        The guess from which to search for the event after the next; its ``time`` is a guess of the wait.
    """


@contract
def no_return_time(p, arc):
    """Return the time from which a bound proves that an arc never comes back, given that ``next_event`` has proved it."""


@contract
def side_to_lift(p, start, drive):
    """Return the side to which a block at rest lifts now, where f > 0; 0 if it stays."""


@contract
def stays_leaning(p, arc):
    """Return whether a block at rest at the brace is pressed against it: brace_angle + f > 0."""


@contract
def acceleration_size(p, drive):
    """Return the absolute value of the base acceleration."""


@contract
def acceleration_change_bound(p, drive, time):
    """Return an upper bound on the change of the base acceleration within the next ``time``."""


@contract
def settling(p, drive, speed):
    """Bound chattering after an impact that leaves at ``speed``.

    Returns
    -------
    tuple of (float, float)
        An upper bound on the time to rest, which comes before lift-off; infinite if rest is not certain.
        An upper bound on the angle until then.
    """


@contract
def brace_settling_time(p, side, drive, speed):
    """Return an upper bound on the time from a brace impact to sustained contact; infinite if that is not certain."""


@contract
def peak_with(p, arc, coming, peak):
    """Return the largest of ``peak`` and the angles of an arc up to the event that ends it."""


@contract
def largest_on(p, arc, until, peak):
    """Return the largest of ``peak`` and the angles of an arc up to the time ``until``."""


@contract
def next_turn(p, arc, sign, t, until):
    """Find the next extremum of the angle after t, where sign u' falls through zero.

    Returns
    -------
    tuple of (int, float, Instant)
        Result, as in ``arc.Found``, with its time and the state there.
    """


@contract
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Return the derivatives of (u, u') a time t into an arc, by the amplitude, the phase at its start and the frequency.

    The other arguments are sinh t, cosh t - 1 and sinh t - t. The sign is that of the response to the base acceleration.

    Returns
    -------
    tuple of six floats
        F_A, F'_A, F_psi, F'_psi, F_Omega and F'_Omega.
    """
