"""Files of a store: those written without Zarr are identical to those that Zarr would write."""

import numpy as np
import pytest
import zarr

from rocking.survey.zarr_files import codecs, encoded

EDGES = (40, 30)


@pytest.mark.parametrize("dtype", ["uint8", "int32", "float32", "float64"])
@pytest.mark.parametrize("ends", [(0, 0), (7, 0), (0, 1), (39, 29)], ids=str)
def test_chunk_is_what_zarr_writes(tmp_path, dtype, ends):
    shape = tuple(edge - short for edge, short in zip(EDGES, ends, strict=True))
    fill = np.inf if dtype.startswith("float") else np.iinfo(dtype).max
    random = np.random.default_rng(7)
    values = (100 * random.random(shape)).astype(dtype)
    values[0] = 3  # what is all the same shrinks
    _, shrink, check = codecs(dtype)
    array = zarr.create_array(
        tmp_path, shape=shape, chunks=EDGES, dtype=dtype, fill_value=fill, compressors=[shrink, check]
    )
    array[:] = values
    assert (tmp_path / "c/0/0").read_bytes() == encoded(values, EDGES, fill)
    assert array.metadata.to_dict()["codecs"][1:] == (shrink, check)


def test_chunk_of_another_byte_order_is_the_same():
    values = np.arange(12.0).reshape(3, 4)
    assert encoded(values.astype(">f8"), (3, 4), np.inf) == encoded(values, (3, 4), np.inf)


def test_chunk_that_repeats_itself_is_small():
    assert len(encoded(np.zeros((200, 200)), (200, 200), np.inf)) < 0.01 * 200 * 200 * 8
