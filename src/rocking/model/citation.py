"""What to cite: the package, and where its equations come from."""

from __future__ import annotations

from rocking.model.version import VERSION

PACKAGE = """@software{{rocking,
  title = {{rocking: exact simulation and nonlinear dynamics of free-standing blocks on a shaking base}},
  version = {{{version}}},
}}"""

SOURCES = """@article{yim-lin-1991,
  author = {Yim, Solomon C. S. and Lin, Huan},
  title = {Nonlinear impact and chaotic response of slender rocking objects},
  journal = {Journal of Engineering Mechanics},
  publisher = {ASCE},
  volume = {117}, number = {9}, pages = {2079--2100}, year = {1991},
  doi = {10.1061/(ASCE)0733-9399(1991)117:9(2079)},
  note = {the model, eqs. (1)-(5), and the responses reproduced},
}

@article{spanos-koh-1984,
  author = {Spanos, Pol D. and Koh, Aik-Siong},
  title = {Rocking of rigid blocks due to harmonic shaking},
  journal = {Journal of Engineering Mechanics},
  publisher = {ASCE},
  volume = {110}, number = {11}, pages = {1627--1642}, year = {1984},
  doi = {10.1061/(ASCE)0733-9399(1984)110:11(1627)},
  note = {the exact solution of the slender block between impacts},
}

@article{housner-1963,
  author = {Housner, George W.},
  title = {The behavior of inverted pendulum structures during earthquakes},
  journal = {Bulletin of the Seismological Society of America},
  volume = {53}, number = {2}, pages = {403--417}, year = {1963},
  note = {the restitution of a block, and free rocking},
}

@article{hogan-1989,
  author = {Hogan, S. John},
  title = {On the dynamics of rigid-block motion under harmonic forcing},
  journal = {Proceedings of the Royal Society of London A},
  volume = {425}, number = {1869}, pages = {441--476}, year = {1989},
  doi = {10.1098/rspa.1989.0114},
  note = {the impact map and the dynamics under harmonic forcing},
}
"""


def cite() -> str:
    """BibTeX for this package and for the sources of its equations.

    Examples
    --------
    >>> print(cite().splitlines()[0])
    @software{rocking,
    """
    return PACKAGE.format(version=VERSION) + "\n\n" + SOURCES
