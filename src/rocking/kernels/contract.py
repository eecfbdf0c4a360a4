"""Functions of a system. The block and the base of ``p``, the parameters of the system, choose the body at compile time.

The march, recordings, and the impact law know the two through these functions and the fields of ``p.block``. The modules of blocks
and bases give the bodies (``library.kernel.body``). Outside them only the lanes and the chains of events, which are of slender
blocks under a cosine, read the ``drive`` and the ``constants`` of an arc.

Functions of finite base motions: a slender arc is u = (K+ e^t + K- e^-t)/2 and bounded terms. So the block leaves for good if
K+ > 0, unless it comes back before.
"""

from rocking.kernels.library.kernel import contract

# Functions of every system.


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
def place_at_start(p, arc):
    """Return the place on an arc from which ``evaluate_onward`` goes on, at its start."""


@contract
def evaluate_onward(p, arc, place, t):
    """Return the ``Instant`` of an arc at a time t not before a place on it, and the last place up to there.

    It repeats no step of the arc, and equals ``evaluate`` to rounding.
    """


@contract
def forcing_term(p, side, drive):
    """Return f = u'' - u on a side of the base, eq. (4): -1 - side * base acceleration."""


@contract
def acceleration(p, side, angle, drive):
    """Return u'' at an angle on a side of the base."""


@contract
def restoring_acceleration(p, side):
    """Return -u'' at the base on a side, without base motion."""


@contract
def change_of_side(p, side, after):
    """Return by what factors -u'' without base motion and the effect of the base acceleration at the base are larger on another side."""


@contract
def is_symmetric(p):
    """Return whether both sides of the block are equal, so that each motion has a mirror image half a period later."""


@contract
def has_wall(p):
    """Return whether the block stands against a wall: it lifts off to the right only, and an impact returns it to that side."""


@contract
def units_of(p, side):
    """Return the ``Units`` of a side of a slender block."""


@contract
def left_half(p):
    """Return the slender system of the left side of a block with unequal sides."""


@contract
def drive_in(source, target, drive, factor):
    """Return the drive of a slender system in the units of another one, whose times are larger by a factor."""


@contract
def restitution_at(p, side, speed):
    """Return the coefficient of an impact that ends an arc on a side at a speed, and the derivative of the speed after it."""


@contract
def restitution_error(p, arc, coming, error):
    """Return an upper bound of the error of the speed after an impact that comes from taking it as linear in the speed before.

    ``error`` is the covariance of (u, u') at the impact, in the units of the arc.
    """


@contract
def at_impact(p, place):
    """Return the system with the coefficient of restitution of the coming impact, by its place (``block.scatter``)."""


@contract
def is_scattered(p):
    """Return whether the coefficient of restitution changes from impact to impact."""


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
def lift_off(p, arc, left_level):
    """Find the lift-off of a slender block that rests, to the right where -a > 1, to the left where a > ``left_level``."""


@contract
def side_above(p, start, drive, left_level):
    """Return the side to which a slender block at rest lifts now, with the levels of ``lift_off``; 0 if it stays."""


@contract
def holds_level(p, drive, coming, left_level):
    """Return whether the base may hold a level of lift-off, up to rounding, from a drive to the lift-off or the proof that none follows.

    Where it only touches a level, a block that lifts off returns before it has moved by more than rounding.
    """


@contract
def held_event(p, mode, arc):
    """Find the lift-off that ends a rest, or the departure that ends a contact with a brace, as ``next_event`` does."""


@contract
def no_return_time(p, arc):
    """Return the time from which a bound proves that an arc never comes back, given that ``next_event`` has proved it."""


@contract
def resting(p):
    """Return the slender system that rests as long as this one, and its level of lift-off to the left; that to the right is 1."""


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
def settling(p, side, drive, speed):
    """Bound chattering after an impact that leaves at ``speed``; the drive is that of an arc on the side.

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
def turn_from(p, arc, sign, start, until):
    """Find the first extremum of the angle from ``start`` on, where sign u' falls through zero.

    ``start`` may be an extremum, at which u' has any sign to rounding.

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


# Functions of the base that the full block needs.


@contract
def series_from(p, side, slope, sine, cosine, drive, short):
    """Return the coefficients of t^2, t^3, ... of u from an instant on, where w' = slope and w has this sine and cosine.

    A ``short`` series has zeros beyond SHORT_ORDER.
    """


@contract
def transfer_series(p, side, slope, sine, cosine, drive):
    """Return the coefficients of t^2, t^3, ... of two perturbations of u, which start with (1, 0) and with (0, 1)."""


@contract
def acceleration_of(p, drive):
    """Return the base acceleration."""


@contract
def weight_of(p, drive):
    """Return the weight of the block relative to that on a base at rest: 1 + the upward acceleration of the base in units of g."""


@contract
def weight_change_bound(p, drive, time):
    """Return an upper bound on the change of the weight within the next ``time``."""


@contract
def lightest_ahead(p, drive):
    """Return a lower bound of the weight from now on, 1 at most."""


@contract
def heaviest_ahead(p, drive):
    """Return an upper bound of the size of the weight from now on, 1 at least."""


@contract
def smooth_time(p, drive):
    """Return the time until the base acceleration has a corner."""


@contract
def drive_later(p, drive, time, to_corner):
    """Return the drive a time later, which is no later than the next corner, or at that corner."""


@contract
def drive_on_clock(p, cycle, start):
    """Return the drive at a time of the clock."""


@contract
def largest_ahead(p, side, drive):
    """Return an upper bound of side * base acceleration from now on, and 0 at least."""


@contract
def largest_within(p, drive, time):
    """Return an upper bound of |base acceleration| up to a time before the next corner, plus |weight - 1|/alpha."""


@contract
def largest_near(p, drive, radius):
    """Return an upper bound of ``largest_within`` in the complex disc around an instant, of the series from there."""


@contract
def excess_push(p):
    """Return by how much alpha |u''| and its derivative by w may exceed r^2 (1 + alpha |a|) at a base acceleration a, over alpha r^2."""


@contract
def stiffness(p, side, sine, cosine, drive):
    """Return du''/du where r^2 sin w and r^2 cos w are these."""


@contract
def growth_of(p, stiffness):
    """Return an upper bound of the square of the rate at which perturbations grow, from du''/du."""


@contract
def parts_at_base(p, side, weight):
    """Return the sum of the sizes of the parts of u'' at the base without base motion, for the size of the weight."""


@contract
def flat_time(p, side, step, drive):
    """Return the time in a step at which a block lies flat, if it might rise again; else infinity."""


@contract
def limits_within(p, arc, step, drive, h, end, extremes):
    """Return the ``Extremes`` with what else errors may change within a time h of a step of an arc, at whose end is the angle ``end``."""


@contract
def never_returns(p, side, angle, velocity, drive):
    """Return whether a block certainly never comes back to the base."""


@contract
def acceleration_near(p, side, sine, change, drive, radius):
    """Return an upper bound of alpha |u''| in the complex disc around an instant.

    There w is within ``change`` of its value at the instant, where r^2 sin w = ``sine``.
    """


@contract
def drive_after_event(p, start, coming):
    """Return the drive of an arc that starts with an event, at a time of the clock."""


@contract
def constants_at(p, start, drive):
    """Return the constants of an arc that starts at a time of the clock."""


@contract
def wave_of(p):
    """Return the cosine that moves the base, for a pulse up to its end."""


# Functions of base motions that end.


@contract
def growth_constant(p, arc):
    """Return K+ of an arc and an estimate of its rounding error. After an impact at tau, K+ = v - 1 - sigma R(tau).

    It is for slender blocks alone. Both are in the units of the side of the arc. So are margins, times and errors of the functions
    below, and minima of ``Extremes``.
    """


@contract
def margin_estimate(p, arc, coming, stretch):
    """Return about the margin of an arc that starts at the base, from the event that ends it and the ``Stretch`` until then."""


@contract
def estimate_error(p):
    """Return about the largest error of ``contract.margin_estimate``."""


@contract
def margin_of(p, arc, estimate, in_batch):
    """Return the margin of an arc that starts at the base, from an estimate: by how much it is faster than a motion that stays bounded.

    In a batch fewer digits suffice.
    """


@contract
def rounding_error(p, arc, wait, growth, steps):
    """Return an estimate of the rounding error of (u, u') that a time ``wait`` along an arc adds.

    ``growth`` is that of a perturbation in this time, and ``steps`` those of the ``Stretch``.
    """


@contract
def end_is_sure(p, arc, coming, error, at_event):
    """Return whether rounding errors cannot have decided on the event that ends an arc, or on the proof that none follows.

    ``error`` and ``at_event`` are the covariances of (u, u') at the start of the arc and at its end.
    """


@contract
def largest_push(p):
    """Return an upper bound of |base acceleration|."""


@contract
def response_ahead(p, drive):
    """Return R, the integral of e^(t - x) times the base acceleration at x over all later times x."""


@contract
def bounded_velocity(p, side, angle, drive):
    """Return about the speed of the motion that stays bounded, and about -1 times its derivative by u."""


@contract
def excess_at_end(p, side, angle, velocity):
    """Return by how much a block is faster than the motion that stays bounded, after the base motion, and -1 times its derivative by u."""


@contract
def approach_of(p):
    """Return the ``Approach`` of the search for the motion that stays bounded."""


@contract
def smooth_step(p, side, angle, velocity, drive):
    """Return a later state of an arc of the full block that no event interrupts: u, u', the mean of du''/du, the time and the drive."""


@contract
def elapsed_until(p, arc, drive):
    """Return the time from the start of an arc to a place of the forcing."""


@contract
def next_event_and_extremes(p, mode, arc, peak):
    """Find the next event as ``contract.next_event`` does, with the ``Extremes`` and the ``Stretch`` of the arc before it.

    ``peak`` is the largest angle so far; if it is infinite, no larger one is wanted.
    """


@contract
def largest_before(p, arc, coming, reached):
    """Return an upper bound of the angle on an arc before its event, where ``Extremes.reached`` is known.

    If it is no larger than that, ``reached`` is the largest angle, and ``peak_with`` is not asked for it.
    """


@contract
def has_ended(p, drive):
    """Return whether the base motion is over."""


@contract
def escape_speed(p):
    """Return the speed above which a block that leaves the base overturns without base motion, if no impact takes energy."""


@contract
def impacts_per_trial(p):
    """Return the number of impacts from one trial to prove that chattering ends in rest to the next."""


# Other systems of the same type.


@contract
def with_run(p, run):
    """Return the parameters of a row of runs under the samples of ``p``."""


@contract
def with_pulse(p, pulse):
    """Return the parameters of a row of pulses; the cycle of the clock lasts as long as the pulse."""


@contract
def with_row(p, row):
    """Return parameters of the same type as p: amplitude, frequency, period, phase, restitution, and those of the block."""


@contract
def later(p, time):
    """Return the system with its clock set to 0 at ``time`` (within a period), which changes its phase."""


# The closed form of symmetric modes.


@contract
def nearest_mode(p, order, angle, velocity):
    """Return the state of the faster symmetric (1, ``order``) mode that is nearest to (angle, velocity).

    The distance of the ``Nearest`` is infinite if no stable mode is known in closed form.
    """
