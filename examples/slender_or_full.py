"""Error of the slender-block model over the slenderness: largest angle, overturning boundary, and outcomes.

Each panel compares the slender block with the full equation of motion, for blocks with the same time scale 1/α. The
comparison is made at the same acceleration a/θcr and at the same a/tan θcr, relative to lift-off. The second one agrees better.
Run ``python examples/slender_or_full.py [FILE]``. It writes the figure to FILE. Default: ``slender-or-full.png`` in the current folder.
"""

import sys

import numpy as np

import rocking as rk

ANGLES = np.array([0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5])
"""Critical angles, rad."""
RESTITUTION = 0.925
LOOKS = (("a/θcr", "o-", np.ones_like(ANGLES)), ("a/tan θcr", "s--", np.tan(ANGLES) / ANGLES))
"""Name of each comparison, its line, and the factor of the amplitude of the full block."""


def largest_angles(factors):
    """Return the relative difference of the largest angles in 20 cycles with A = 2 and T = 1."""

    def peak(amplitude, critical_angle=None):
        forcing = rk.Harmonic(amplitude, period=1.0)
        return rk.simulate(rk.System(forcing, RESTITUTION, critical_angle=critical_angle), cycles=20).peak

    full = [peak(2.0 * factor, angle) for factor, angle in zip(factors, ANGLES, strict=True)]
    return peak(2.0) / np.array(full) - 1.0


def boundaries(factors):
    """Return the relative difference of the lowest amplitudes of a sine pulse that overturn a block at rest."""
    levels = np.linspace(1.0, 8.0, 2_801)

    system = rk.System(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), RESTITUTION)

    def lowest(**block):
        result = rk.overturning_spectrum(system, amplitude=levels, frequency=[3.0, 6.0], **block).dataset.sel(
            frequency=3.0
        )
        overturned = result.outcome == list(rk.Outcome).index(rk.Outcome.OVERTURNED)
        return levels[overturned.argmax("amplitude").values]

    return lowest() / (lowest(critical_angle=ANGLES) / factors) - 1.0


def kinds(factors):
    """Return the fraction of a map over A and T whose kind of response differs."""
    amplitudes, periods = np.linspace(1.1, 8.0, 24), np.linspace(0.4, 2.4, 24)

    def kind(factor, critical_angle=None):
        system = rk.System(rk.Harmonic(2.0, period=1.0), RESTITUTION, critical_angle=critical_angle)
        result = rk.parametric_map(
            system, amplitude=factor * amplitudes, period=periods, max_cycles=1_000
        ).dataset
        return result.kind.values

    slender = kind(1.0)
    full = [kind(factor, critical_angle=angle) for factor, angle in zip(factors, ANGLES, strict=True)]
    return np.array([np.mean(each != slender) for each in full])


def verdicts(factors):
    """Return the fraction of runs under 20 records whose outcome differs, with peaks of 1 to 4 times that of lift-off."""
    records, size = rk.synthetic_ground_motions(20, seed=1, duration=10.0), 1.5
    levels = np.linspace(1.0, 4.0, 16)
    shares = []
    for angle, factor in zip(ANGLES.tolist(), factors.tolist(), strict=True):
        outcomes = [
            rk.rocking_spectrum(
                records,
                size=size,
                slenderness=angle,
                restitution=RESTITUTION,
                levels=levels * strength,
                intensity="pga-ratio",
                model=model,
            ).dataset.outcome.values
            for model, strength in (("slender", 1.0), ("full", factor))
        ]
        shares.append(np.mean(outcomes[0] != outcomes[1]))
    return np.array(shares)


PANELS = (
    ("largest angle, A = 2, T = 1", "error (%)", largest_angles),
    ("overturning amplitude, sine pulse", "error (%)", boundaries),
    ("kind of response in a map", "different points (%)", kinds),
    ("outcome under 20 records", "different runs (%)", verdicts),
)


def draw():
    """Draw a panel per quantity, with a line per comparison."""
    figure, axes = rk.plot.panels(rows=2, columns=2, height=2.4)
    for ax, (title, label, measure) in zip(axes, PANELS, strict=True):
        for (name, line, factors), colour in zip(LOOKS, ("#0072B2", "#D55E00"), strict=True):
            ax.plot(
                np.degrees(ANGLES), 100 * measure(factors), line, color=colour, markersize=3.5, label=name
            )
        rk.plot.title(ax, title)
        ax.set(xlabel="critical angle θcr (°)", ylabel=label)
        ax.axhline(0.0, color="#9A9A9A", linewidth=0.6, zorder=0)
        ax.spines[["top", "right"]].set_visible(False)
    axes[0].legend(frameon=False, title="at the same")
    return figure


if __name__ == "__main__":
    print(rk.plot.save(draw(), sys.argv[1] if len(sys.argv) > 1 else "slender-or-full.png"))
