"""Which orbit of its look each point of a picture comes to, so that mirror images do not look like one."""

from __future__ import annotations

import numpy as np

from rocking.survey import alike

MAX_ATTRACTORS = 16
"""Orbits of one look that are told apart: more are no list of attractors."""


class Orbits:
    """The orbits met so far, numbered from 0 within each look in the order in which they were met."""

    def __init__(self) -> None:
        self.met: dict[int, list[np.ndarray]] = {}

    def numbers(self, looks: np.ndarray, states: np.ndarray) -> np.ndarray:
        """The numbers (n,) of the orbits that these states (n, 2) stand for; 0 too where there is none, or are too many."""
        found = np.zeros(len(looks), np.uint8)
        there = np.isfinite(states).all(axis=1)
        for look in np.unique(looks[there]).tolist():
            self._number(
                found, np.flatnonzero(there & (looks == look)), states, self.met.setdefault(look, [])
            )
        return found

    def _number(self, found: np.ndarray, left: np.ndarray, states: np.ndarray, met: list[np.ndarray]) -> None:
        for number in range(MAX_ATTRACTORS):
            if not left.size:
                return
            if number == len(met):
                met.append(states[left[0]].copy())
            rows = alike(states[left], met[number][None])[:, 0]
            found[left[rows]] = number
            left = np.delete(left, rows)
