"""Machine code of the builders gives the same bits as that compiled in the process that calls it."""

import pytest

from benchmarks import machine_code
from rocking.kernels.machine_code import CLASSES


@pytest.mark.long
@pytest.mark.parametrize("processors", CLASSES)
def test_every_entry_point_gives_the_same_bits(processors):
    if processors not in machine_code.comparable():
        pytest.skip(f"this processor lacks instructions of {processors}")
    found = machine_code.compare(processors)
    assert sorted(found) == machine_code.ALL
    assert min(each.calls for each in found.values()) > 0
    assert [name for name, each in found.items() if each.others] == []
