"""`rocking assess`: one page for a client from one TOML file, with tables beside it."""

from __future__ import annotations

from collections.abc import Iterable
from importlib.resources import files
from pathlib import Path

from rocking.assessment.assess import Assessment, assess
from rocking.assessment.page import write_page
from rocking.assessment.sentences import answers_of
from rocking.assessment.tables import table_paths, write_csv, write_xlsx
from rocking.cli.assessment_file import Case, read_case
from rocking.cli.options import InvalidInput, refusals
from rocking.cli.output import WARNING, styled
from rocking.cli.record_requests import digest
from rocking.model.files import check_folder, check_writable, replacing, resolve_path
from rocking.model.package import missing_extra
from rocking.model.tables_and_json import json_text
from rocking.model.text import formatted_path
from rocking.model.validation import Refusal

EXAMPLE = Path(str(files("rocking.assessment").joinpath("example.toml")))
"""File of an assessment that comes with the package."""


def run(file: Path, output: Path | None, json: bool) -> None:
    """Compute what a file of an assessment asks for, write the page and the tables, and print the main results."""
    is_example = str(file) == "example"
    if is_example:
        file = EXAMPLE
    case = read_case(file)
    folder = output or (Path() if is_example else file.parent)
    with refusals({"path": "--output"}):
        check_folder("--output", folder)
        stem = folder / file.stem
        page, book, copy = (stem.with_name(f"{stem.name}.{kind}") for kind in ("html", "xlsx", "toml"))
        lacking = missing_extra("excel")
        copies = [copy] if is_example else []
        for path in (page, *table_paths(stem), *([] if lacking else [book]), *copies):
            if folder.exists():
                check_writable("path", path)
                check_no_input(path, case)
    results = [computed(case, place) for place in range(len(case.blocks))]
    with refusals():
        folder.mkdir(parents=True, exist_ok=True)
    written = [
        write_page(page, results, title=case.title, by=case.by, notes=case.warnings),
        *write_csv(stem, results),
        *([] if lacking else [write_xlsx(book, results)]),
        *copies,
    ]
    for path in copies:
        with replacing(path) as temporary:
            temporary.write_bytes(EXAMPLE.read_bytes())
    if json:
        entries = {
            "title": case.title,
            "blocks": [result.to_dict() for result in results],
            "warnings": case.warnings,
            "files": [str(path) for path in written],
        }
        print(json_text(entries))
        return
    for line in lines_of(results, case.warnings):
        print(styled(line, fg="yellow") if line.startswith(WARNING) else line)
    for path in written:
        print(f"wrote {path}")
    if lacking:
        print(f"{book} was not written: {lacking}")


def check_no_input(path: Path, case: Case) -> None:
    """Raise InvalidInput for an output in place of an input."""
    records = {motion.file.sha256 for motion in case.records if motion.file is not None}
    if resolve_path("path", path) in map(Path.resolve, case.inputs) or digest(path) in records:
        raise InvalidInput(
            f"{formatted_path(path)} is an input and would be overwritten: give another folder by --output"
        )


def computed(case: Case, place: int) -> Assessment:
    """Return the assessment of one block of a case; messages name its section."""
    block = case.blocks[place]
    try:
        return assess(
            case.records,
            block.block,
            case.levels,
            level=case.level,
            intensity=case.intensity,
            limits=case.limits_of(block.block),
            friction=block.friction,
            name=block.name,
            progress=True,
            **case.others,
        )
    except (TypeError, ValueError) as error:
        told = error.of(case.names) if isinstance(error, Refusal) else error
        raise InvalidInput(f"{case.place}: {told}") from error


def lines_of(results: Iterable[Assessment], warnings: Iterable[str]) -> Iterable[str]:
    """Yield the lines that are printed."""
    for result in results:
        if result.name:
            yield f"{result.name} ({result.block.size})"
        yield from answers_of(result)
        yield from (f"{WARNING}{note}" for note in result.notes)
    yield from (f"{WARNING}{warning}" for warning in warnings)
