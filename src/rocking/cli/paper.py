"""`rocking paper` and `rocking cite`: papers on rocking."""

from __future__ import annotations

from pathlib import Path

from rocking.cli.options import refusals


def paper(figures: tuple[str, ...], output: Path | None, list: bool) -> None:  # noqa: A002 (the name of the option)
    """Reproduce figures and numbers of a paper, or print the names of the papers."""
    from rocking.papers.catalogue import PAPERS

    if list:
        for each in PAPERS.values():
            print(f"{each.name}  {each.subject}")
        return
    name, *rest = figures if figures and figures[0] in PAPERS else (next(iter(PAPERS)), *figures)
    write(name, rest, Path("results") / name if output is None else output)


def write(name: str, figures: list[str], folder: Path) -> None:
    """Write figures of a paper to a folder; without `figures` all of them, and a report."""
    from rocking.model.files import check_folder
    from rocking.model.progress import Bar
    from rocking.model.text import counted
    from rocking.model.validation import Refusal
    from rocking.papers.catalogue import PAPERS
    from rocking.papers.report.page import PAGE
    from rocking.papers.report.reproduce import reproduce

    with refusals(), Bar(what="computing"):
        check_folder("--output", folder)
        try:
            PAPERS[name].known(figures)
        except Refusal as error:
            remedy = f"the reports are {' and '.join(PAPERS)}"
            raise Refusal(error.argument, error.allowed, error.value, remedy) from error
    last: list[str] = []
    written = reproduce(PAPERS[name], folder, figures or None, progress=True, summary=last.append)
    if figures:
        for path in written:
            print(f"wrote {path}")
    else:
        print(f"wrote {counted(len(written), 'file')} into {folder}")
        last.append(f"open {folder / PAGE}")
    if last:
        print("; ".join(last))


def cite() -> None:
    """Print BibTeX entries of the package and its sources."""
    import rocking as rk

    print(rk.cite(), end="")
