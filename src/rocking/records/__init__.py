"""Ground motions from record files, one that comes with the package, and synthetic ones."""

from rocking.records.channel import RecordError
from rocking.records.example import FILE as EXAMPLE_FILE
from rocking.records.example import example_ground_motion
from rocking.records.read import read_ground_motion, read_ground_motions
from rocking.records.read_record_set import read_record_set
from rocking.records.reading_process import read_apart
from rocking.records.synthetic import synthetic_ground_motions

__all__ = [
    "EXAMPLE_FILE",
    "RecordError",
    "example_ground_motion",
    "read_apart",
    "read_ground_motion",
    "read_ground_motions",
    "read_record_set",
    "synthetic_ground_motions",
]
