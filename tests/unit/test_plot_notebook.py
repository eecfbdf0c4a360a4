"""Owners of the figures of plot functions: variables, pyplot once it is imported, and notebooks, which show each figure once."""

import sys
from functools import cache
from importlib import import_module
from types import SimpleNamespace

import pytest
from matplotlib.figure import Figure

import rocking as rk
from rocking.plot import figures

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)


@cache
def motion():
    return rk.simulate(SYSTEM, cycles=20)


@cache
def motion_of_record():
    return rk.simulate(rk.Block(2.0, 0.5).system(rk.example_ground_motion(), model="slender"))


@cache
def verdict():
    return rk.classify(SYSTEM)


@cache
def diagram():
    return rk.response_diagram(SYSTEM, amplitude=[1.0, 2.0, 3.0])


PLOTS = {
    "axes": lambda: rk.plot.phase_portrait(motion()),
    "panels": lambda: rk.plot.panels(columns=2),
    "history": lambda: rk.plot.time_history(motion()),
    "history over the base": lambda: rk.plot.time_history(motion_of_record()),
    "overview": lambda: rk.plot.overview(motion()),
    "overview over the base": lambda: rk.plot.overview(motion_of_record()),
    "verdict": lambda: rk.plot.verdict(verdict()),
    "diagram": lambda: rk.plot.response_diagram(diagram()),
}
BLOCK = "wrong"
REFUSED = {
    "basins": lambda: rk.plot.basins(
        rk.basin_map(SYSTEM, angle=[0.0, 0.1], velocity=[0.0, 0.1], boundary_runs=0), block=BLOCK
    ),
    "history": lambda: rk.plot.time_history(motion(), block=BLOCK),
    "overturning": lambda: rk.plot.overturning(
        rk.overturning_amplitude(
            rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
            period=[1.5, 2.0],
            amplitude=[1.0, 4.0],
            phases=2,
        ),
        block=BLOCK,
    ),
    "overview": lambda: rk.plot.overview(motion(), BLOCK),
    "safe basin": lambda: rk.plot.safe_basin(
        rk.safe_basin(
            rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.8), amplitude=[3.3, 3.7], samples=20
        ),
        block=BLOCK,
    ),
    "schematic": lambda: rk.plot.schematic(block=BLOCK),
    "thresholds": lambda: rk.plot.thresholds([1.0, 2.0], {"bound": [1.0]}),
    "verdict": lambda: rk.plot.verdict(verdict(), BLOCK),
}


@pytest.fixture
def pyplot():
    """Pyplot as a script imports it; no later test finds it imported."""
    yield import_module("matplotlib.pyplot")
    sys.modules.pop("matplotlib.pyplot").close("all")


class Notebook:
    """Kernel with the protocol of IPython and its inline backend.

    It shows what a cell returns, and at the end of the cell all figures of pyplot, which it closes.
    """

    version_info = (9, 0)

    def __init__(self):
        self.kernel, self.shown = "a kernel", []
        self.events = SimpleNamespace(register=lambda *_: None)

    def get_ipython(self):
        return self

    def display(self, result):
        if not isinstance(result, Figure):
            return
        try:
            result._ipython_display_()
        except NotImplementedError:
            self.shown.append(result)

    def run(self, cell):
        self.shown.clear()
        self.display(cell())
        pyplot = sys.modules["matplotlib.pyplot"]
        for number in pyplot.get_fignums():
            self.display(pyplot.figure(number))
        pyplot.close("all")
        return list(self.shown)


@pytest.fixture
def notebook(monkeypatch):
    notebook = Notebook()
    monkeypatch.setitem(sys.modules, "IPython", notebook)
    monkeypatch.setattr(figures, "get_backend", lambda: "module://matplotlib_inline.backend_inline")
    monkeypatch.delitem(sys.modules, "matplotlib.pyplot", raising=False)
    yield notebook
    sys.modules.pop("matplotlib.pyplot").close("all")


@pytest.mark.parametrize("name", PLOTS)
def test_figure_of_a_script_without_pyplot_is_its_own(name):
    PLOTS[name]()
    assert "matplotlib.pyplot" not in sys.modules


@pytest.mark.parametrize("name", PLOTS)
def test_pyplot_owns_the_figure_once_it_is_imported(pyplot, name):
    drawn = PLOTS[name]()
    figure = drawn[0] if isinstance(drawn, tuple) else drawn.figure
    assert [pyplot.figure(number) for number in pyplot.get_fignums()] == [figure]


@pytest.mark.parametrize("name", ["history", "overview over the base", "verdict"])
def test_figure_of_pyplot_is_saved_as_the_same_bytes(pyplot, tmp_path, name):
    with figures.apart():
        alone = rk.plot.save(PLOTS[name](), tmp_path / "alone.png").read_bytes()
    assert not pyplot.get_fignums()
    PLOTS[name]()
    pyplot.savefig(tmp_path / "by-pyplot.png", dpi=200, metadata={"Software": None})
    assert (tmp_path / "by-pyplot.png").read_bytes() == alone


def test_pyplot_gets_no_figure_where_axes_are_given_or_nobody_sees_it(pyplot, tmp_path):
    rk.plot.time_history(motion(), Figure().add_subplot())
    rk.plot.animation(motion(), tmp_path / "block.gif", seconds=0.1)
    assert motion()._repr_html_().startswith("<figure>")
    assert verdict()._repr_html_().startswith("<figure>")
    assert not pyplot.get_fignums()


@pytest.mark.parametrize("name", REFUSED)
def test_refused_call_leaves_no_empty_figure(pyplot, name):
    with pytest.raises((TypeError, ValueError), match="^(block|curves) must"):
        REFUSED[name]()
    assert not pyplot.get_fignums()


@pytest.mark.parametrize("name", PLOTS)
def test_notebook_shows_the_figure_once_in_the_cell_that_makes_it(notebook, name):
    assert len(notebook.run(PLOTS[name])) == 1
    assert len(notebook.run(lambda: print(PLOTS[name]()))) == 1  # not the last line of the cell
    assert len(notebook.run(lambda: print("no plot"))) == 0


def test_notebook_shows_a_figure_again_where_a_later_cell_returns_it(notebook):
    (figure,) = notebook.run(PLOTS["overview"])
    assert notebook.run(lambda: figure) == [figure]


def test_notebook_shows_a_figure_once_that_the_cell_displays_or_saves(notebook, tmp_path):
    def displayed():
        figure = PLOTS["overview"]()
        notebook.display(figure)
        sys.modules["matplotlib.pyplot"].close(figure)

    assert len(notebook.run(displayed)) == 1
    assert len(notebook.run(lambda: rk.plot.save(PLOTS["overview"](), tmp_path / "a.png"))) == 1


def test_notebook_shows_a_result_without_a_second_figure(notebook):
    def cell():
        import_module("matplotlib.pyplot")
        assert motion()._repr_html_().startswith("<figure>")

    assert notebook.run(cell) == []


def test_figure_in_another_backend_stays_open_where_a_cell_returns_it(notebook, monkeypatch):
    monkeypatch.setattr(figures, "get_backend", lambda: "qtagg")
    figure = PLOTS["overview"]()
    notebook.display(figure)
    assert notebook.shown == [figure]
    assert sys.modules["matplotlib.pyplot"].fignum_exists(figure.number)


def test_terminal_of_ipython_imports_no_pyplot(monkeypatch):
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=SimpleNamespace))
    PLOTS["axes"]()
    assert "matplotlib.pyplot" not in sys.modules
