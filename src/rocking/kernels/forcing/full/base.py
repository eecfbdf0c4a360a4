"""Functions of the base motion that the full block needs; each forcing provides them.

The march knows the full block by ``forcing.contract``. These functions are between the two.
"""

from rocking.kernels.deferred import contract


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
    """Return an upper bound of |base acceleration| up to a time before the next corner."""


@contract
def largest_near(p, drive, radius):
    """Return an upper bound of |base acceleration| in the complex disc around an instant, of the series from there."""


@contract
def lift_off(p, arc):
    """Return the lift-off that ends a rest."""


@contract
def departure(p, arc):
    """Return the departure that ends a contact with a brace."""


@contract
def stays_at_brace(p, arc):
    """Return whether a block at rest at the brace is pressed against it."""


@contract
def side_to_lift_at(p, start, drive):
    """Return the side to which a block at rest lifts now; 0 if it stays."""


@contract
def change_within(p, drive, time):
    """Return an upper bound on the change of the base acceleration within a time."""


@contract
def drive_after_event(p, start, coming):
    """Return the drive of an arc that starts with an event, at a time of the clock."""


@contract
def constants_at(p, start, drive):
    """Return the constants of an arc that starts at a time of the clock."""
