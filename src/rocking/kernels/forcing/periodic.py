"""Functions that the parameters of a periodic forcing provide besides those of ``contract``.

Every forcing here has the fields ``amplitude``, ``frequency``, ``period``, ``phase`` and ``per_frequency``.
"""

from rocking.kernels.deferred import contract


@contract
def with_row(p, row):
    """Return parameters of the same type as p: amplitude, frequency, period, phase, restitution, and those of the block."""


@contract
def later(p, time):
    """Return the system with its clock set to 0 at ``time`` (within a period), which changes its phase."""


@contract
def nearest_mode(p, order, angle, velocity):
    """Return the state of the faster symmetric (1, ``order``) mode that is nearest to (angle, velocity).

    The distance of the ``Nearest`` is infinite if no stable mode is known in closed form.
    """
