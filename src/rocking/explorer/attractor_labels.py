"""Labels of the attractors in a basin map, so that mirror images have different shades."""

from __future__ import annotations

import numpy as np

from rocking.survey.attractors import alike

MAX_ATTRACTORS = 16
"""Maximum number of distinct orbits per category; a longer list is of no use as a legend."""


class Orbits:
    """Orbits found so far, numbered from 0 within each category of `LOOKS`, in order of discovery."""

    def __init__(self) -> None:
        self.met: dict[int, list[np.ndarray]] = {}

    def numbers(self, looks: np.ndarray, states: np.ndarray) -> np.ndarray:
        """Return the number of the orbit of each state, and add new orbits.

        Parameters
        ----------
        looks : array of int (n,)
            Indices in `LOOKS`.
        states : array of float (n, 2)
            Reference states (Θ, Θ') of the orbits; NaN without an orbit.

        Returns
        -------
        array of uint8 (n,)
            Numbers of the orbits; 0 also without an orbit and beyond `MAX_ATTRACTORS`.
        """
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
