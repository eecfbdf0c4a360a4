"""Numbers of pairs of points within given radii, counted with k-d trees."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Places = NDArray[np.intp]

STEPS_PER_OCTAVE = 4
# Beyond the spread of the points, the pair count saturates.
MAX_RADIUS = 0.5
BLOCKS = 16
# With fewer close pairs in a block, the logarithm of their number is dominated by noise.
MIN_PAIRS = 64
REFERENCES = 2_000
# Largest number of pairs listed individually, at about 100 bytes each.
MAX_PAIRS = 3e6


def pairs_within(scaled: Array, theiler: int, same: float) -> tuple[Array, Array, Array]:
    """Count pairs within radii, for reference points in blocks that are consecutive in time.

    Pairs that follow each other by at most ``theiler`` points are excluded. Radii are larger than ``same``.

    Returns
    -------
    radii : ndarray, shape (n,)
        Radii in ascending order.
    counts, pairs : ndarray, shape (blocks, n)
        Number of pairs within each radius, and number of all pairs.
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(scaled)
    nearest = np.sort(tree.query(scaled, k=2)[0][:, 1])
    smallest = max(float(nearest[MIN_PAIRS]), same)
    octaves = max(math.log2(MAX_RADIUS / smallest), 0.0)
    radii = MAX_RADIUS * 2.0 ** (-np.arange(int(octaves * STEPS_PER_OCTAVE), -1, -1) / STEPS_PER_OCTAVE)
    # Large radii need few reference points; small radii use all points.
    few = np.sort(np.random.default_rng(0).permutation(len(scaled))[:REFERENCES])
    counts, pairs = _counted(tree, few, theiler, radii)
    near = int(np.searchsorted(0.5 * counts.sum(axis=0) * len(scaled) / len(few), MAX_PAIRS))
    if near and len(few) < len(scaled):
        counts[:, :near], pairs[:, :near] = _listed(tree, theiler, radii[:near])
    scarce = np.flatnonzero(counts.min(axis=0) < MIN_PAIRS)
    first = int(scarce[-1]) + 1 if scarce.size else 0
    return radii[first:], counts[:, first:], pairs[:, first:]


def _counted(tree: Any, chosen: Places, theiler: int, radii: Array) -> tuple[Array, Array]:
    """Count pairs of selected reference points with all points, one tree per block."""
    from scipy.spatial import cKDTree

    counts = []
    for block in np.array_split(chosen, BLOCKS):
        close = np.zeros(len(radii))
        for lag in range(-theiler, theiler + 1):
            here = block[(block + lag >= 0) & (block + lag < tree.n)]
            close += _within(tree.data[here + lag] - tree.data[here], radii)
        counts.append(cKDTree(tree.data[block]).count_neighbors(tree, radii) - close)
    return np.array(counts), np.repeat(_admitted(chosen, tree.n, theiler), len(radii), axis=1)


def _listed(tree: Any, theiler: int, radii: Array) -> tuple[Array, Array]:
    """Count pairs of all points by listing them."""
    listed = tree.query_pairs(radii[-1], output_type="ndarray")
    listed = listed[np.abs(listed[:, 1] - listed[:, 0]) > theiler]
    distances = np.sqrt(((tree.data[listed[:, 0]] - tree.data[listed[:, 1]]) ** 2).sum(axis=1))
    bins = np.searchsorted(radii, distances)
    everyone = np.arange(tree.n)
    block_of = np.repeat(np.arange(BLOCKS), [len(block) for block in np.array_split(everyone, BLOCKS)])
    cells = sum(
        np.bincount(block_of[listed[:, end]] * len(radii) + bins, minlength=BLOCKS * len(radii))
        for end in (0, 1)
    )
    counts = np.cumsum(np.reshape(cells, (BLOCKS, len(radii))), axis=1).astype(float)
    return counts, np.repeat(_admitted(everyone, tree.n, theiler), len(radii), axis=1)


def _within(differences: Array, radii: Array) -> NDArray[np.intp]:
    distances = np.sort(np.sqrt((differences**2).sum(axis=1)))
    return np.searchsorted(distances, radii, side="right")


def _admitted(chosen: Places, points: int, theiler: int) -> Array:
    """Number of points outside the Theiler windows of the selected points, shape (blocks, 1)."""
    outside = np.maximum(chosen - theiler, 0) + np.maximum(points - 1 - chosen - theiler, 0)
    return np.array([[float(block.sum())] for block in np.array_split(outside, BLOCKS)])
