"""Contents of a report: figures, tables and claims of a paper, which register themselves by the decorators of `Paper`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from enum import StrEnum
from importlib import import_module
from typing import Any, TypeVar

from attrs import field, frozen

from rocking.papers.report.claim import Chapter

Function = TypeVar("Function", bound=Callable[..., Any])
CLAIMS = "claims"
"""Name of the table of claims, which is written with the verdicts."""


class Kind(StrEnum):
    """Kind of a part of a report; names of files begin with it."""

    FIGURE = "figure"
    TABLE = "table"
    ADDITIONAL = "beyond"


@frozen
class Part:
    """Figure or table of a report.

    Attributes
    ----------
    kind : Kind
        Figure of the paper, table, or figure that the paper does not have.
    name : str
        Name in the report.
    compute : callable
        Function without arguments that draws the figure, or function of a folder that writes the table. The docstring of a
        figure is its caption.
    cost : float
        Approximate processor time, s, for progress and for the order of the steps.
    pixels : bool
        Whether the page shows the figure as PNG, because it has many points.
    """

    kind: Kind
    name: str
    compute: Callable[..., Any]
    cost: float
    pixels: bool = False

    @property
    def stem(self) -> str:
        """Name of the files of a figure, without suffix."""
        return f"{self.kind}-{self.name:>02}"

    @property
    def text(self) -> str:
        """Name in the progress of a report."""
        return f"figure {self.name}" if self.kind is Kind.FIGURE else self.name


@frozen(eq=False)
class Paper:
    """Contents of a report.

    Attributes
    ----------
    name : str
        Name of the report in the command line.
    subject : str
        Line in a list of reports.
    title, lead : str
        Title and first paragraph of the page; `{version}` in the paragraph is replaced.
    source : str
        Source of the claims, such as "the paper".
    modules : sequence of str
        Modules of `rocking.papers` that register figures and tables, in the order of the report.
    claims : sequence of str
        Modules of `rocking.papers` that register chapters of claims, in the order of the report.
    page_cost : float
        Approximate processor time of the page, s.
    """

    name: str
    subject: str
    title: str
    lead: str
    source: str
    modules: Sequence[str]
    claims: Sequence[str]
    page_cost: float
    _parts: list[Part] = field(init=False, factory=list)
    _chapters: list[Chapter] = field(init=False, factory=list)

    def figure(self, name: str, cost: float, pixels: bool = False) -> Callable[[Function], Function]:
        """Register the decorated function as a figure of the paper; its docstring is the caption."""
        return self._registered(Kind.FIGURE, name, cost, pixels)

    def additional(self, name: str, cost: float, pixels: bool = False) -> Callable[[Function], Function]:
        """Register the decorated function as a figure that the paper does not have; its docstring is the caption."""
        return self._registered(Kind.ADDITIONAL, name, cost, pixels)

    def table(self, name: str, cost: float) -> Callable[[Function], Function]:
        """Register the decorated function as a table."""
        return self._registered(Kind.TABLE, name, cost)

    def chapter(self, title: str) -> Chapter:
        """Return a new chapter of claims, which register by its own decorator."""
        self._chapters.append(Chapter(title))
        return self._chapters[-1]

    def _registered(
        self, kind: Kind, name: str, cost: float, pixels: bool = False
    ) -> Callable[[Function], Function]:
        def register(compute: Function) -> Function:
            self._parts.append(Part(kind, name, compute, cost, pixels))
            return compute

        return register

    @property
    def chapters(self) -> Sequence[Chapter]:
        """Chapters of claims."""
        _import(self.claims)
        return self._chapters

    @property
    def parts(self) -> dict[str, Part]:
        """Figures and tables except "claims", by name."""
        _import(self.modules)
        return {part.name: part for part in self._parts}

    def of(self, kind: Kind) -> list[Part]:
        """Return the parts of one kind."""
        return [part for part in self.parts.values() if part.kind is kind]

    @property
    def names(self) -> list[str]:
        """Names of figures, tables and additional figures, in the order of the report."""
        figures, tables, additional = ([part.name for part in self.of(kind)] for kind in Kind)
        return [*figures, *tables, CLAIMS, *additional]

    def known(self, names: Iterable[str | int]) -> list[str]:
        """Return names as text; Refusal if the report lacks one."""
        from rocking.model.validation import Refusal

        texts = [str(name) for name in names]
        for name in texts:
            if name not in self.names:
                raise Refusal("figures", f"be among {', '.join(self.names)}", name)
        return texts


def _import(modules: Iterable[str]) -> None:
    for module in modules:
        import_module(f"rocking.papers.{module}")
