"""Tables beside the page: one CSV file per table, in UTF-8 with a mark that Excel reads, and one XLSX file with a sheet per table."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rocking.assessment.assess import Assessment
from rocking.model.files import check_writable, replacing
from rocking.model.result import Result
from rocking.model.tables_and_json import as_typed

if TYPE_CHECKING:
    import pandas as pd

CSV_ENCODING = "utf-8-sig"
TABLES = ("records", "fragility", "overturning", "sensitivity", "rate", "files")
"""Names of the tables: of the CSV files after a hyphen, and of the sheets."""


def table_paths(stem: Path) -> list[Path]:
    """Return the paths of all CSV files that a report can have.

    Examples
    --------
    >>> [path.name for path in table_paths(Path("cabinet"))][:2]
    ['cabinet-records.csv', 'cabinet-fragility.csv']
    """
    return [stem.with_name(f"{stem.name}-{name}.csv") for name in TABLES]


def tables(assessments: Sequence[Assessment]) -> dict[str, pd.DataFrame]:
    """Return the tables of a report by name, in SI units; with several blocks their first column is the block.

    Without an annual rate there is no table of it.
    """
    import pandas as pd

    first = assessments[0]

    def joined(parts: Sequence[tuple[Result | None, str | None]]) -> pd.DataFrame:
        frames = []
        for place, (part, name) in enumerate(parts):
            if part is not None:
                frame = part.to_dataframe(name)
                for heading in frame:
                    frame[heading] = as_typed(str(heading), frame[heading].to_numpy())
                if len(parts) > 1:
                    frame.insert(0, "block", assessments[place].name or f"Block {place + 1}")
                frames.append(frame)
        return pd.concat(frames, ignore_index=True) if frames else pd.DataFrame({"note": ["not computed"]})

    found = {
        "records": joined([(each, None) for each in assessments]),
        "fragility": joined([(each.fragility, None) for each in assessments]),
        "overturning": joined([(each.overturning_set, "interval") for each in assessments]),
        "sensitivity": joined([(each.sensitivity, None) for each in assessments]),
        "rate": joined([(each.rate, None) for each in assessments]),
        "files": _files(first),
    }
    if all(each.rate is None for each in assessments):
        del found["rate"]
    return found


def _files(each: Assessment) -> pd.DataFrame:
    import pandas as pd

    rows = [
        {
            "record": place,
            "name": name,
            "file": "" if motion.file is None else motion.file.name,
            "format": "" if motion.file is None else motion.file.format,
            "channel": "" if motion.file is None else motion.file.channel,
            "sha256": "" if motion.file is None else motion.file.sha256,
            "samples": motion.times.size,
            "step [s]": motion.step,
            "factor": motion.factor,
            "baseline removed": motion.baseline,
        }
        for place, (name, motion) in enumerate(zip(each.records.names, each.records, strict=True))
    ]
    return pd.DataFrame(rows)


def write_csv(stem: str | os.PathLike[str], assessments: Sequence[Assessment]) -> list[Path]:
    """Write the tables as CSV files and return their paths; errors as in `write_page`."""
    found = tables(assessments)
    paths = [path for path, name in zip(table_paths(Path(stem)), TABLES, strict=True) if name in found]
    for path, frame in zip(paths, found.values(), strict=True):
        with replacing(check_writable("path", path)) as temporary:
            frame.to_csv(temporary, index=False, encoding=CSV_ENCODING)
    return paths


def write_xlsx(path: str | os.PathLike[str], assessments: Sequence[Assessment]) -> Path:
    """Write the tables as sheets of one file and return its path.

    Raises
    ------
    ImportError
        If openpyxl, of the extra `excel`, is not installed.
    TypeError, ValueError, OSError
        If the file cannot be written.
    """
    import pandas as pd

    path = check_writable("path", path, (".xlsx",))
    with replacing(path) as temporary, pd.ExcelWriter(temporary, engine="openpyxl") as book:
        for name, frame in tables(assessments).items():
            frame.to_excel(book, sheet_name=name, index=False, freeze_panes=(1, 0))
            for column, heading in zip(book.sheets[name].columns, frame.columns, strict=True):
                book.sheets[name].column_dimensions[column[0].column_letter].width = max(
                    10, len(str(heading)) + 2
                )
    return path
