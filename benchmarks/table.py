"""Table of measured figures, each with its goal."""

from typing import NamedTuple

from rich.console import Console
from rich.table import Table


class Figure(NamedTuple):
    """Measured figure; `goal` is its upper bound or, with `least`, its lower bound. Default: no goal."""

    what: str
    value: float
    unit: str
    goal: float | None = None
    least: bool = False
    note: str = ""

    @property
    def met(self):
        return self.value >= self.goal if self.least else self.value <= self.goal

    def judged(self):
        if self.goal is None:
            return "", ""
        sign = "≥" if self.least else "≤"
        return f"{sign} {shown(self.goal, self.unit)}", "met" if self.met else "[bold]missed[/]"


def shown(value, unit):
    return f"{value:,.3g} {unit}" if value < 1000 else f"{value:,.0f} {unit}"


class Report:
    """Report that prints each section as soon as it is measured."""

    def __init__(self):
        self.console = Console(width=118, highlight=False)
        self.figures = []

    def section(self, title, figures):
        table = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False)
        table.add_column(min_width=40)
        table.add_column("measured", justify="right", min_width=12)
        table.add_column("goal", justify="right", min_width=12)
        table.add_column(min_width=6)
        table.add_column()
        for figure in figures:
            table.add_row(figure.what, shown(figure.value, figure.unit), *figure.judged(), figure.note)
            self.figures.append(figure)
        self.console.print(table, "")

    def close(self):
        goals = [figure for figure in self.figures if figure.goal is not None]
        self.console.print(f"{sum(figure.met for figure in goals)} of {len(goals)} goals met")
