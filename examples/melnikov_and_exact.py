"""Melnikov's threshold A_M compared with the exact tangency amplitude A*.

Run ``python examples/melnikov_and_exact.py [FILE]``. It prints a table and writes the figure to FILE. Default:
``melnikov-and-exact.png`` in the current folder.
"""

import sys

import numpy as np

import rocking as rk

PERIODS = np.geomspace(0.1, 20.0, 400)
RESTITUTIONS = (0.5, 0.8, 0.925)


def equal_at(restitution):
    """Return the period at which both are equal: ((1+e)²/4)² (1 + Ω²((1−e)/(1+e))²) = 1."""
    share = (1 - restitution) / (1 + restitution)
    omega = np.sqrt((4 / (1 + restitution) ** 2) ** 2 - 1) / share
    return 2 * np.pi / omega


def table():
    """Print both thresholds and their ratio, over periods and restitutions."""
    print("   e      T       A_M        A*    A_M/A*")
    for restitution in RESTITUTIONS:
        for period in (0.2, 0.5, 1.0, 2.0, 5.0):
            first = rk.theory.melnikov_amplitude(period, restitution)
            exact = rk.theory.heteroclinic_amplitude(period, restitution)
            print(f"{restitution:5.3f} {period:5.1f} {first:10.5f} {exact:9.5f} {first / exact:8.4f}")
        print(f"      equal at T = {equal_at(restitution):.4f}")


def draw():
    """Draw the thresholds at e = 0.5 and their ratio at each restitution."""
    figure, (left, right) = rk.plot.panels(columns=2, height=3.2)
    shown = PERIODS[(PERIODS > 0.5) & (PERIODS < 6)]
    curves = {
        "$A_M$, $e = 0.5$": rk.theory.melnikov_amplitude(shown, 0.5),
        "$A^*$, $e = 0.5$": rk.theory.heteroclinic_amplitude(shown, 0.5),
    }
    rk.plot.thresholds(shown, curves, left)
    left.set_yscale("log")
    for restitution, dashes in zip(RESTITUTIONS, ("-", "--", ":"), strict=True):
        first = rk.theory.melnikov_amplitude(PERIODS, restitution)
        exact = rk.theory.heteroclinic_amplitude(PERIODS, restitution)
        right.plot(PERIODS, first / exact, dashes, color="#0072B2", label=f"$e = {restitution}$")
    right.axhline(1.0, color="#9A9A9A", linewidth=0.6)
    right.set(xscale="log", yscale="log")
    right.set_xlabel("period $T$", fontsize=9)
    right.set_ylabel("$A_M/A^*$", fontsize=9)
    right.tick_params(labelsize=8)
    right.spines[["top", "right"]].set_visible(False)
    right.legend(frameon=False, fontsize=8)
    return figure


if __name__ == "__main__":
    table()
    print(rk.plot.save(draw(), sys.argv[1] if len(sys.argv) > 1 else "melnikov-and-exact.png"))
