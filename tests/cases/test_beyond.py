"""Figures beyond the paper: titles and captions agree with the points shown."""

import inspect
import itertools
import re

import numpy as np
import pytest

import rocking as rk
from rocking.model.text import percent
from rocking.papers.yim_lin_1991 import beyond, surveys
from rocking.papers.yim_lin_1991.figures import figure_11


def title(ax):
    return ax.get_title(loc="left")


def caption(draw):
    return " ".join(inspect.cleandoc(draw.__doc__).split())


def points(ax, gid):
    return [np.column_stack(line.get_data()) for line in ax.lines if line.get_gid() == gid]


def test_titles_of_the_crisis_are_those_of_the_runs_that_are_drawn(monkeypatch):
    monkeypatch.setattr(rk, "classify", None)  # whose run may follow another chaotic transient
    left, right = beyond.crisis().axes
    for ax, amplitude in ((left, 4.86), (right, 4.88)):
        assert f"$A = {amplitude}$" in title(ax)
        (transient,), settled = points(ax, "section"), points(ax, "settled")
        assert len(transient) + sum(map(len, settled)) == beyond.CYCLES + 1 - beyond.LEFT_OUT
        told = re.search(r"period (\d+) from cycle ([\d,]+) on", title(ax))
        assert (told is None) == (not settled)
        assert ("not periodic" in title(ax)) == (not settled)
        if settled:
            period, cycle = (int(word.replace(",", "")) for word in told.groups())
            assert cycle == beyond.LEFT_OUT + len(transient)
            apart = [np.hypot(*(settled[0][n:] - settled[0][:-n]).T).max() for n in range(1, period + 1)]
            assert apart[-1] <= 1e-3 < min(apart[:-1], default=1.0)
            # the last point before them has not yet come back
            before = np.concatenate([transient[-1:], settled[0]])
            assert np.hypot(*(before[period] - before[0])) > 1e-3
    assert "2·10⁴ cycles" in caption(beyond.crisis)
    assert beyond.CYCLES == 20_000


def test_texts_of_the_basins_have_the_exponents_and_fractions_that_were_computed(monkeypatch):
    made, basin_map = [], rk.basin_map
    monkeypatch.setattr(beyond, "COUNT", 40)
    monkeypatch.setattr(
        rk, "basin_map", lambda *given, **named: made.append(basin_map(*given, **named)) or made[-1]
    )
    (ax,) = beyond.coexistence().axes
    (found,) = made
    texts = [text.get_text() for text in ax.texts]
    assert (
        f"uncertainty exponent\nof all boundaries: {found.attractor_exponent}\n"
        f"of the boundary of overturning: {found.uncertainty_exponent}"
    ) in texts
    labels = {
        f"{each.name}\n{percent(share.value)}"
        for each, share in zip(found.attractors, found.fractions, strict=True)
        if share.value >= 1e-3
    }
    assert labels < set(texts)
    assert ax.get_legend() is None
    assert 0.0 < found.attractor_exponent.low < found.attractor_exponent.high < 1.0


def test_enlarged_boundary_is_as_finely_divided_as_its_title_says(monkeypatch):
    made, parametric_map = [], rk.parametric_map
    monkeypatch.setattr(
        rk, "parametric_map", lambda *system, **axes: made.append(parametric_map(*system, **axes)) or made[-1]
    )
    figure = beyond.zoom()
    for ax, found in zip(figure.axes, made, strict=True):
        kinds = found.dataset.kind.transpose("amplitude", "period").values.tolist()
        pairs = [(one == 4) != (other == 4) for row in kinds for one, other in itertools.pairwise(row)]
        told = float(re.search(r"([\d.]+) % of neighbouring points differ", title(ax))[1])
        assert told == round(100 * sum(pairs) / len(pairs), 1)
        assert told > 10 / 2.39  # more than ten times what one smooth boundary across would give
        # and yet there are regions without a change
        rows = [
            np.diff(np.flatnonzero([True, *np.not_equal(row[1:], row[:-1]), True])).max() for row in kinds
        ]
        assert max(rows) > 24


def test_axes_of_the_enlargement_count_from_its_centre_without_an_offset(monkeypatch):
    monkeypatch.setattr(beyond, "COUNT", 24)
    left, right = beyond.zoom().axes
    assert (right.get_xlabel(), right.get_ylabel()) == ("$T - T_0$ (10⁻⁴)", "$A - A_0$ (10⁻³)")
    right.figure.draw_without_rendering()
    assert [text.get_text() for text in right.get_xticklabels()] == ["−4", "−2", "0", "2", "4"]
    assert [text.get_text() for text in right.get_yticklabels()] == ["−2", "−1", "0", "1", "2"]
    for ax in (left, right):
        assert {axis.get_offset_text().get_text() for axis in (ax.xaxis, ax.yaxis)} == {""}
    square = [line.get_xydata()[0] for line in left.lines if line.get_marker() == "s"]
    np.testing.assert_array_equal(square, [beyond.CENTRE] * 2)


def test_caption_of_the_share_of_chaos_says_what_is_drawn(reproduced):
    shares = dict(zip(surveys.RESTITUTIONS, surveys.chaos().shares, strict=True))
    text = caption(beyond.chaos)
    assert "about every fifth system is chaotic at e = 0.2" in text
    assert shares[0.2].low <= 0.2 <= shares[0.2].high
    values = [share.value for e, share in shares.items() if e <= 0.8]
    assert "decreases as e grows to 0.8" in text
    assert values == sorted(values, reverse=True)
    assert "no chaotic system was found at e = 0.8, 0.9, 0.925, 0.95 and 0.97" in text
    assert [e for e, share in shares.items() if not share.count] == [0.8, 0.9, 0.925, 0.95, 0.97]
    assert "a few systems are chaotic at e = 1" in text
    assert shares[1.0].count > 2
    assert {share.of for share in shares.values()} == {400}


def test_caption_of_figure_11_says_what_lies_beyond_the_first_curve(reproduced):
    found = surveys.damped().transpose("amplitude", "period")
    breaking = rk.theory.symmetry_breaking_amplitude(found.period.values, 0.925, 1)
    beyond = found.amplitude.values[:, None] > breaking
    stay = beyond & (found.kind.values != 4)
    alike = (found.kind == 1) & (found.response_period == 1) & (found.symmetric == 0)
    assert "most points overturn; nearly all others have period 1 and are asymmetric" in caption(figure_11)
    assert stay.sum() < 0.5 * beyond.sum()
    assert (stay & alike.values).sum() > 0.95 * stay.sum()


@pytest.mark.long
def test_caption_of_the_bifurcation_curves_tells_what_is_drawn(monkeypatch):
    shown = rk.parametric_map(surveys.SYSTEM, **surveys.axes(8), max_cycles=200).dataset
    monkeypatch.setattr(surveys, "damped", lambda: shown)
    monkeypatch.setattr(beyond, "GRID", 3)
    searched, bifurcation_set = [], rk.bifurcation_set
    monkeypatch.setattr(
        rk,
        "bifurcation_set",
        lambda *given, **named: searched.append((given[1], named)) or bifurcation_set(*given, **named),
    )
    whole, part = beyond.bifurcations().axes
    ((max_period, named),) = searched
    curves = [line for line in whole.lines if line.get_gid() not in (None, "codimension-2")]
    assert title(whole) == f"(a) {len(curves)} curves"
    assert part.get_ylim() == (1.3, 5.0)
    text = caption(beyond.bifurcations)
    assert f"up to period {max_period} over" in text
    assert f"above A = {named['amplitude'][0]}" in text
    assert "12 × 12 points" in text


def test_orbit_of_period_3_stays_stable_below_its_region_of_the_map():
    """As the caption of the bifurcation curves says; the edge of the region is that of a basin."""

    def response(amplitude):
        return rk.classify(rk.System(rk.Harmonic(amplitude, period=0.3), 0.925))

    branch = rk.continue_orbit(response(4.0).orbit, "amplitude", (1.3, 4.0))
    assert branch.period == 3
    assert branch.points["stable"].all()
    assert branch.points["parameter"].min() == 1.3
    assert response(3.4).period == 1
