"""Runs of a block under ground motions of several scales: the engine and others, with the error of each.

RK4 takes ten steps per sample and interpolates the instants of lift-off and impact. It runs to the end of the motion, as does
the engine. So does DOP853, which takes a block for resting after a slow impact. Heyoka runs to the last of the first fast
impacts only. Both are compared with the engine at scales that differ by up to NEARBY. Errors are those of the times of the
first fast impacts against 60 digits.
"""

import math
from functools import partial
from statistics import geometric_mean
from typing import NamedTuple

import heyoka as hy
import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

import rocking as rk
from benchmarks.clock import quickest, quickest_in_turn
from benchmarks.table import Figure
from rocking.kernels.base.samples import tables_of
from rocking.kernels.motion.finite_motion import ENDING_ROW, RUN_ROW, run_batch
from rocking.kernels.system import CYCLE, sampled_system, slender_block
from tests.oracles import segments

TURNS = 15
SCALES = 50
# Scales of the engine, for which it makes its tables once.
MANY_SCALES = 2_000
# Scales of the errors.
CHECKED = 4
STEPS = 10
FAST_IMPACTS, FAST = 15, 1e-2
NEARBY = 0.02
STRONG = 2.0
# Angle beyond which a block counts as overturned.
FALLEN = 3.0
OVER_RK4, OVER_RK4_ON_AVERAGE, OVER_DOP853 = 10, 25, 20_000
OVER_ULP = 10
BLOCKS = {"h 2 m": rk.Block(height=2.0, width=0.5), "h 8 m": rk.Block(height=8.0, width=1.6)}
SIMULATION_MS = 1.0
SURVEY_S = 10.0


class Cell(NamedTuple):
    """Ground motion for one block: samples in units of lift-off, step in τ, restitution."""

    name: str
    values: np.ndarray
    step: float
    restitution: float

    def scales(self, count):
        """Return factors from 1.02 to 5 times that of lift-off."""
        return np.geomspace(1.02, 5.0, count) / np.abs(self.values).max()


def cells():
    """Yield each of three motions for each block."""
    motions = (
        ("Loma Prieta", rk.example_ground_motion()),
        *((f"synthetic {k}", one) for k, one in enumerate(rk.synthetic_ground_motions(2, seed=1), 1)),
    )
    for name, motion in motions:
        for size, block in BLOCKS.items():
            forcing = block.system(motion, model="slender").forcing
            yield Cell(f"{name}, {size}", forcing.values * forcing.scale, forcing.step, block.restitution)


def engine(cell, scales):
    """Return a function that makes the tables and runs the engine over scales."""
    rows, never = np.empty(len(scales), ENDING_ROW), np.zeros(1, np.int64)
    runs = np.zeros(len(scales), RUN_ROW)
    runs["scale"], runs["restitution"] = scales, cell.restitution

    def run():
        tables = tables_of(cell.values, cell.step)
        p = sampled_system(slender_block(cell.restitution), tables, 1.0, CYCLE * cell.step)
        run_batch(p, runs, False, rows, never)

    return run


@njit
def rk4(values, step, scale, restitution, impacts):
    """Integrate one run; return 1 if it overturns, and the number of fast impacts, whose times go to ``impacts``."""
    h, angle, velocity, side, count, resting = step / STEPS, 0.0, 0.0, 1.0, 0, True
    last = len(values) - 1
    for k in range(STEPS * (last + int(20.0 / step))):
        index, place = k // STEPS, (k % STEPS) / STEPS
        here = middle = after = 0.0
        if index < last:
            start, change = scale * values[index], scale * (values[index + 1] - values[index])
            here, middle, after = (
                start + change * place,
                start + change * (place + 0.5 / STEPS),
                start + change * (place + 1.0 / STEPS),
            )
        if resting:
            if abs(after) <= 1.0:
                if index >= last:
                    return 0, count
                continue
            # The block lifts within the step: u = rate t^3/6 from there on.
            resting, side, rate = False, -1.0 if after > 0.0 else 1.0, abs(after - here) / h
            if abs(here) < 1.0:
                rest = (abs(after) - 1.0) / rate
                angle, velocity = side * rate * rest**3 / 6.0, side * rate * rest**2 / 2.0
                continue
        a1 = angle - side - here
        v2 = velocity + 0.5 * h * a1
        a2 = angle + 0.5 * h * velocity - side - middle
        v3 = velocity + 0.5 * h * a2
        a3 = angle + 0.5 * h * v2 - side - middle
        v4 = velocity + h * a3
        a4 = angle + h * v3 - side - after
        angle_after = angle + h / 6.0 * (velocity + 2.0 * v2 + 2.0 * v3 + v4)
        velocity_after = velocity + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
        if side * angle_after < 0.0:
            share = angle / (angle - angle_after)
            speed = velocity + share * (velocity_after - velocity)
            if abs(speed) > FAST and count < FAST_IMPACTS:
                impacts[count] = (k + share) * h
                count += 1
            # The rest of the step is a parabola, with the velocity just after the impact.
            speed, side, rest = restitution * speed, -side, (1.0 - share) * h
            velocity_after = speed - rest * (side + after)
            angle_after = rest * (speed - 0.5 * rest * (side + after))
            if abs(speed) < 1e-4 and abs(after) <= 1.0:
                angle_after, velocity_after, resting = 0.0, 0.0, True
        angle, velocity = angle_after, velocity_after
        if abs(angle) > FALLEN:
            return 1, count
    return 0, count


def runge_kutta(cell, scales):
    """Return a function that runs RK4 over scales; each run gives the times of its fast impacts."""
    impacts = np.empty(FAST_IMPACTS)

    def run():
        return [
            impacts[: rk4(cell.values, cell.step, scale, cell.restitution, impacts)[1]].copy()
            for scale in scales
        ]

    return run


def lift_off(cell, scale, index=0):
    """Return a state just after the next lift-off: sample, side, time since the sample, and (Θ, Θ'); None if none follows.

    A general integrator cannot find the first crossing of an arc that starts on Θ = 0 with Θ' = 0.
    """
    values = scale * cell.values
    later = np.flatnonzero(np.abs(values[index:]) > 1.0)
    if not len(later):
        return None
    first = index + int(later[0])
    start, end = abs(values[first - 1]), abs(values[first])
    side, rate = -math.copysign(1.0, values[first]), (end - start) / cell.step
    early = 1e-3 * (end - 1.0) / rate
    state = [side * rate * early**3 / 6.0, side * rate * early**2 / 2.0]
    return first - 1, side, (1.0 - start) / rate + early, state


def dop853(cell, scales):
    """Return a function that runs SciPy's DOP853 over scales; each run gives the times of its first fast impacts."""
    return lambda: [_dop853(cell, float(scale)) for scale in scales]


def _dop853(cell, scale):
    values, step, until = cell.values * scale, cell.step, (len(cell.values) - 1) * cell.step
    times = np.arange(len(values)) * step

    def base(time):
        return np.interp(time, times, values)

    def angle(_, state):
        return state[0]

    def fallen(_, state):
        return abs(state[0]) - FALLEN

    angle.terminal = fallen.terminal = True
    impacts, lifted = [], lift_off(cell, scale)
    while lifted:
        first, side, early, state = lifted
        time = first * step + early
        while time < until:
            angle.direction = -side
            arc = solve_ivp(
                lambda at, y, side=side: (y[1], y[0] - side - base(at)),
                (time, until),
                state,
                method="DOP853",
                rtol=1e-10,
                atol=1e-13,
                max_step=step,
                events=(angle, fallen),
            )
            if not len(arc.t_events[0]):
                return np.array(impacts)
            time, speed = float(arc.t[-1]), arc.y[1, -1]
            if abs(speed) < FAST and abs(base(time)) <= 1.0:
                break
            impacts.append(time)
            side, state = -side, [0.0, cell.restitution * speed]
        lifted = lift_off(cell, scale, int(time / step) + 1)
    return np.array(impacts)


class Heyoka:
    """Integrator heyoka at its default tolerance, from sample to sample as far as the last, with impacts as events."""

    def __init__(self, restitution):
        angle, velocity = hy.make_vars("angle", "velocity")
        # par: side, acceleration at the sample and its rate; the time is that since the sample
        push = hy.par[1] + hy.par[2] * hy.time
        self.impacts, self.before = [], 0.0

        def impact(block, slope):
            speed = abs(block.state[1])
            if speed > FAST:
                self.impacts.append(self.before + block.time)
            block.state[1] *= restitution
            block.pars[0] = -block.pars[0]
            return speed > FAST

        self.block = hy.taylor_adaptive(
            [(angle, velocity), (velocity, angle - hy.par[0] - push)],
            [0.0, 0.0],
            t_events=[hy.t_event(angle, callback=impact)],
            pars=[1.0, 0.0, 0.0],
        )

    def run(self, cell, scale):
        """Return the times of the fast impacts until the first slow one, or until FAST_IMPACTS."""
        (first, side, early, state), block = lift_off(cell, scale), self.block
        self.impacts.clear()
        block.reset_cooldowns()
        block.state[:], block.pars[0], block.time = state, side, early
        for index in range(first, len(cell.values) - 1):
            start, end = scale * cell.values[index : index + 2]
            block.pars[1:], self.before = (start, (end - start) / cell.step), index * cell.step
            outcome, *_ = block.propagate_until(cell.step)
            if outcome != hy.taylor_outcome.time_limit or len(self.impacts) >= FAST_IMPACTS:
                break
            block.time = 0.0
        return np.array(self.impacts[:FAST_IMPACTS])


def heyoka(cell, scales):
    """Return a function that runs heyoka over scales."""
    peer = Heyoka(cell.restitution)
    return lambda: [peer.run(cell, float(scale)) for scale in scales]


def times_of_simulation(cell, scales):
    """Return the times of the fast impacts of each run, by the engine."""
    found = []
    for scale in map(float, scales):
        base = rk.PiecewiseLinear(cell.values, step=cell.step, scale=scale)
        events = rk.simulate(rk.System(base, restitution=cell.restitution)).events
        found.append(events["time"][(events["kind"] == "impact") & (np.abs(events["before"]) > FAST)])
    return found


def scale_of_fast_impacts(cell):
    """Return the scale whose run begins with most fast impacts, of which a general integrator misses none.

    It is at least STRONG times that of lift-off, so that the engine cannot prove at once that the block comes to rest.
    """
    counts = []
    for scale in cell.scales(SCALES):
        if scale * np.abs(cell.values).max() < STRONG:
            continue
        base = rk.PiecewiseLinear(cell.values, step=cell.step, scale=float(scale))
        events = rk.simulate(rk.System(base, restitution=cell.restitution)).events
        slow = (events["kind"][1:] != "impact") | (np.abs(events["before"][1:]) <= FAST)
        counts.append((min(int(slow.argmax()) if slow.any() else len(slow), FAST_IMPACTS), -scale))
    return -max(counts)[1]


def exact_times(cell, scale):
    """Return the times of the first fast impacts in 60 digits."""
    run = segments.motion(cell.values, cell.step, cell.restitution, scale=float(scale))
    return [impact.time for impact in run.impacts if impact.speed > FAST][:FAST_IMPACTS]


def errors(wanted, found):
    """Return the errors of the times of the impacts that both have."""
    return np.array([abs(float(exact - time)) for exact, time in zip(wanted, found, strict=False)])


def error(cell, scales, found):
    """Return the median of the largest errors of the runs' first fast impacts."""
    off = [
        errors(exact_times(cell, scale), times[:FAST_IMPACTS])
        for scale, times in zip(scales, found, strict=True)
    ]
    worst = [each.max() for each in off if len(each)]
    return float(np.median(worst)) if worst else 0.0


def rounding():
    """Compare the errors of the times of fast impacts with the effect of one unit in the last place of the scale."""
    ratios = []
    for cell in cells():
        scales = cell.scales(CHECKED + 1)[1:]
        for scale, times in zip(scales, times_of_simulation(cell, scales), strict=True):
            wanted = exact_times(cell, scale)
            effect = errors(wanted, exact_times(cell, np.nextafter(scale, math.inf)))
            ratios += [
                one / other for one, other in zip(errors(wanted, times), effect, strict=False) if other > 0.0
            ]
    median, most = np.quantile(ratios, (0.5, 0.9))
    note = f"median of {len(ratios)} impacts; 90 % are below {most:.3g}"
    return Figure(
        "Error of impact times, effect of one ulp of the scale", float(median), "×", OVER_ULP, note=note
    )


def speed():
    """Time one run of the engine, and the ratios of the times of the others; then one simulation beyond the tables."""
    ratios = []
    for cell in cells():
        scales, checked = cell.scales(SCALES), cell.scales(CHECKED + 1)[1:]
        ours, theirs = engine(cell, cell.scales(MANY_SCALES)), runge_kutta(cell, scales)
        theirs()
        (mine, _), (rk4_time, _) = quickest_in_turn(TURNS, (ours, theirs))
        note = f"per run; error {error(cell, checked, times_of_simulation(cell, checked)):.1e}"
        yield Figure(cell.name, 1e6 * mine / MANY_SCALES, "µs", note=note)
        ratios.append(rk4_time / SCALES / (mine / MANY_SCALES))
        note = f"error {error(cell, checked, runge_kutta(cell, checked)()):.1e}"
        yield Figure("  RK4, ten steps per sample", ratios[-1], "×", OVER_RK4, least=True, note=note)
        few = [scale_of_fast_impacts(cell)]
        for name, way, goal in (
            ("SciPy DOP853, rtol 1e-10", dop853, OVER_DOP853),
            ("heyoka", heyoka, None),
        ):
            slow, found = quickest(1, way(cell, few))
            fast, _ = quickest(
                TURNS, engine(cell, few[0] * np.linspace(1.0 - NEARBY, 1.0 + NEARBY, MANY_SCALES))
            )
            note = f"{slow:.2g} s, {len(found[0])} impacts; error {error(cell, few, found):.1e}"
            yield Figure(f"  {name}", slow / (fast / MANY_SCALES), "×", goal, least=True, note=note)
    mean = geometric_mean(ratios)
    yield Figure("RK4, geometric mean", mean, "×", OVER_RK4_ON_AVERAGE, least=True)
    yield rounding()
    yield simulation()
    yield survey()


def survey():
    """Time a spectrum of 100 records, 100 sizes and 100 scales, tables included."""
    records = rk.RecordSet(rk.synthetic_ground_motions(100, seed=1))
    sizes, scales = np.linspace(0.5, 4.0, 100), np.linspace(0.3, 3.0, 100)
    ask = partial(rk.rocking_spectrum, records, slenderness=0.2)
    ask(size=sizes[:2], levels=scales[:2])  # loads the kernels
    taken, found = quickest(3, partial(ask, size=sizes, scale=scales))
    return Figure(
        f"spectrum, {found.outcome.size:,} runs", taken, "s", SURVEY_S, note="on all cores, tables included"
    )


def simulation():
    """Time `simulate` of a motion whose tables are made."""
    cell = next(cells())
    base = rk.PiecewiseLinear(cell.values, step=cell.step, scale=float(cell.scales(3)[1]))
    time, _ = quickest(20, partial(rk.simulate, rk.System(base, restitution=cell.restitution)))
    return Figure(f"simulate, {cell.name}", 1e3 * time, "ms", SIMULATION_MS, note="with tables made")
