"""Peers: general integrators that detect the impacts, SciPy's DOP853 and heyoka's Taylor series.

Both run in their fastest form: scalar right-hand sides, one event function, no dense output, compiled before timing.
"""

from math import cos

import heyoka as hy
import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.cases import Point


def scipy_march(case, start, until):
    """March by DOP853 at rtol 1e-12, restarted after each impact; return (impacts, final point)."""
    amplitude, frequency = case.amplitude, case.frequency
    side = 1.0 if start.angle > 0 else -1.0

    def rates(time, state):
        return state[1], state[0] - side - amplitude * cos(frequency * time)

    def angle(time, state):
        return state[0]

    angle.terminal = True
    time, state, impacts = start.time, (start.angle, start.velocity), 0
    while True:
        angle.direction = -side
        arc = solve_ivp(rates, (time, until), state, method="DOP853", rtol=1e-12, atol=1e-14, events=angle)
        time, (theta, velocity) = arc.t[-1], arc.y[:, -1]
        if arc.status != 1:
            return impacts, Point(float(time), float(theta), float(velocity))
        impacts, side, state = impacts + 1, -side, (0.0, case.restitution * velocity)


class Heyoka:
    """Integrator heyoka at its default tolerance (2.2e-16), with impacts in the callback of a terminal event.

    `variations` adds the first-order variational equations and their jump at each impact. `lean` writes through
    memory views kept from the start; else the callback gets the arrays from the integrator, as in the manual.
    """

    def __init__(self, case, variations=False, lean=False):
        angle, velocity = hy.make_vars("angle", "velocity")
        push = case.amplitude * hy.cos(case.frequency * hy.time)
        equations = [(angle, velocity), (velocity, angle - hy.par[0] - push)]
        if variations:
            equations = hy.var_ode_sys(equations, hy.var_args.vars, order=1)
        self.views, self.count = [], [0]
        callback = IMPACTS[variations, lean](case, self.count, self.views)
        event = hy.t_event(angle, callback=callback)
        self.integrator = hy.taylor_adaptive(equations, [0.0, 0.0], t_events=[event], pars=[1.0])
        self.views += [memoryview(self.integrator.state), memoryview(self.integrator.pars)]
        self.rest = self.integrator.state.copy()

    def march(self, start, until):
        """March from `start` to the time `until`; return (impacts, final point)."""
        block = self.integrator
        block.state[:] = self.rest
        block.state[:2] = start.angle, start.velocity
        block.pars[0] = 1.0 if start.angle > 0 else -1.0
        block.time = start.time
        block.reset_cooldowns()
        self.count[0] = 0
        block.propagate_until(until)
        return self.count[0], Point(block.time, float(block.state[0]), float(block.state[1]))


def plain_impact(case, count, views):
    def impact(block, slope):
        block.state[1] *= case.restitution
        block.pars[0] = -block.pars[0]
        count[0] += 1
        return True

    return impact


def lean_impact(case, count, views):
    restitution = case.restitution

    def impact(block, slope):
        state, parameters = views
        state[1] *= restitution
        parameters[0] = -parameters[0]
        count[0] += 1
        return True

    return impact


def variational_impact(case, count, views):
    def impact(block, slope):
        state, side, velocity = block.state, block.pars[0], block.state[1]
        push = case.amplitude * cos(case.frequency * block.time)
        corner = (side - push - case.restitution * (-side - push)) / velocity
        jump = np.array([[case.restitution, 0.0], [corner, case.restitution]])
        tangent = jump @ state[2:].reshape(2, 2)
        state[2:] = within_tolerance(tangent).ravel()
        state[1] *= case.restitution
        block.pars[0] = -side
        count[0] += 1
        return True

    return impact


def within_tolerance(tangent):
    """Shrink a tangent of size above 1: heyoka's error is relative to the largest component, so it would cost digits."""
    return tangent * 1e-3 if abs(tangent).max() > 1 else tangent


def lean_variational_impact(case, count, views):
    amplitude, frequency, restitution = case.amplitude, case.frequency, case.restitution

    def impact(block, slope):
        state, parameters = views
        side, velocity = parameters[0], state[1]
        push = amplitude * cos(frequency * block.time)
        corner = (side - push + restitution * (side + push)) / velocity
        a, b = state[2], state[3]
        c, d = corner * a + restitution * state[4], corner * b + restitution * state[5]
        a, b = restitution * a, restitution * b
        if abs(c) > 1 or abs(d) > 1:
            a, b, c, d = 1e-3 * a, 1e-3 * b, 1e-3 * c, 1e-3 * d
        state[2], state[3], state[4], state[5] = a, b, c, d
        state[1] = restitution * velocity
        parameters[0] = -side
        count[0] += 1
        return True

    return impact


IMPACTS = {
    (False, False): plain_impact,
    (False, True): lean_impact,
    (True, False): variational_impact,
    (True, True): lean_variational_impact,
}
