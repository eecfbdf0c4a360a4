"""The package: its version, its optional dependencies, and how to cite it."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

VERSION = __version__ = "0.2.0"


EXTRAS = {
    "excel": ("XLSX files need openpyxl", ("openpyxl",)),
    "explorer": (
        "the explorer needs Bokeh, h5netcdf, h5py and Jinja",
        ("bokeh", "h5netcdf", "h5py", "jinja2"),
    ),
    "film": ("MP4 files need imageio-ffmpeg", ("imageio_ffmpeg",)),
    "netcdf": ("netCDF files need h5netcdf and h5py", ("h5netcdf", "h5py")),
    "obspy": ("ObsPy reads more formats", ("obspy",)),
    "proof": ("proofs need python-flint", ("flint",)),
    "report": ("the report needs Jinja and WeasyPrint", ("jinja2", "weasyprint")),
    "store": ("stores need Zarr and numcodecs", ("zarr", "numcodecs")),
}
"""For each extra of pyproject.toml: what needs its packages, and their modules."""
FORMATS = {".mp4": "film", ".nc": "netcdf", ".xlsx": "excel"}
"""Extras that write files, by the suffix of the file."""


class ExtraMissing(ImportError):
    """A package of an extra is not installed. The message is one sentence with the remedy."""


def missing_extra(extra: str) -> str:
    """Return the message for an extra of which a package is not installed; empty if all are installed.

    Examples
    --------
    >>> missing_extra("netcdf")
    ''
    """
    need, modules = EXTRAS[extra]
    if all(map(_installed, modules)):
        return ""
    return f"{need}: run pip install '.[{extra}]' in a copy of the repository"


def require_extra(extra: str) -> None:
    """Raise ExtraMissing unless all packages of an extra are installed."""
    if message := missing_extra(extra):
        raise ExtraMissing(message)


def require_format(path: Path) -> None:
    """Raise ExtraMissing if a file with this suffix needs an extra that is not installed."""
    if extra := FORMATS.get(path.suffix.lower()):
        require_extra(extra)


def _installed(module: str) -> bool:
    """Return whether a module can be imported; it is not imported."""
    if module in sys.modules:
        return sys.modules[module] is not None
    return find_spec(module) is not None


PACKAGE = """@software{{rocking,
  author = {{{{The rocking authors}}}},
  title = {{rocking: exact simulation and nonlinear dynamics of free-standing blocks on a shaking base}},
  version = {{{version}}}, year = {{2026}},
}}"""

SOURCES = """@article{yim-lin-1991,
  author = {Yim, Solomon C. S. and Lin, Huan},
  title = {Nonlinear impact and chaotic response of slender rocking objects},
  journal = {Journal of Engineering Mechanics},
  publisher = {ASCE},
  volume = {117}, number = {9}, pages = {2079--2100}, year = {1991},
  annote = {Model, Eqs. (1)--(5), and the responses reproduced by this package.},
}

@article{spanos-koh-1984,
  author = {Spanos, Pol D. and Koh, Aik-Siong},
  title = {Rocking of rigid blocks due to harmonic shaking},
  journal = {Journal of Engineering Mechanics},
  publisher = {ASCE},
  volume = {110}, number = {11}, pages = {1627--1642}, year = {1984},
  doi = {10.1061/(ASCE)0733-9399(1984)110:11(1627)},
  annote = {Exact solution for the slender block between impacts, symmetric modes and their stability.},
}

@article{housner-1963,
  author = {Housner, George W.},
  title = {The behavior of inverted pendulum structures during earthquakes},
  journal = {Bulletin of the Seismological Society of America},
  volume = {53}, number = {2}, pages = {403--417}, year = {1963},
  annote = {Coefficient of restitution, free rocking of a block, and overturning by one pulse.},
}

@article{hogan-1989,
  author = {Hogan, S. John},
  title = {On the dynamics of rigid-block motion under harmonic forcing},
  journal = {Proceedings of the Royal Society of London A},
  volume = {425}, number = {1869}, pages = {441--476}, year = {1989},
  annote = {Impact map and dynamics under harmonic forcing.},
}

@article{shi-1996,
  author = {Shi, Baoping and Anooshehpoor, Abdolrasool and Zeng, Yuehua and Brune, James N.},
  title = {Rocking and overturning of precariously balanced rocks by earthquakes},
  journal = {Bulletin of the Seismological Society of America},
  volume = {86}, number = {5}, pages = {1364--1371}, year = {1996},
  annote = {Overturning of a block by a half sine.},
}

@article{shenton-1996,
  author = {Shenton, Harry W.},
  title = {Criteria for initiation of slide, rock, and slide-rock rigid-body modes},
  journal = {Journal of Engineering Mechanics},
  publisher = {ASCE},
  volume = {122}, number = {7}, pages = {690--693}, year = {1996},
  doi = {10.1061/(ASCE)0733-9399(1996)122:7(690)},
  annote = {First motion of a block on a rough base.},
}

@article{sorrentino-2011,
  author = {Sorrentino, Luigi and AlShawa, Omar and Decanini, Luis D.},
  title = {The relevance of energy damping in unreinforced masonry mechanisms. {E}xperimental and analytical investigations},
  journal = {Bulletin of Earthquake Engineering},
  volume = {9}, number = {5}, pages = {1617--1642}, year = {2011},
  annote = {Coefficient of restitution of a block against a wall.},
}

@article{newmark-1965,
  author = {Newmark, Nathan M.},
  title = {Effects of earthquakes on dams and embankments},
  journal = {G{\\'e}otechnique},
  volume = {15}, number = {2}, pages = {139--160}, year = {1965},
  doi = {10.1680/geot.1965.15.2.139},
  annote = {Sliding block.},
}

@article{makris-roussos-2000,
  author = {Makris, Nicos and Roussos, Yiannis},
  title = {Rocking response of rigid blocks under near-source ground motions},
  journal = {G{\\'e}otechnique},
  volume = {50}, number = {3}, pages = {243--262}, year = {2000},
  annote = {Overturning by half sine, one sine and one cosine.},
}

@article{zhang-makris-2001,
  author = {Zhang, Jian and Makris, Nicos},
  title = {Rocking response of free-standing blocks under cycloidal pulses},
  journal = {Journal of Engineering Mechanics},
  publisher = {ASCE},
  volume = {127}, number = {5}, pages = {473--483}, year = {2001},
  annote = {Two modes of overturning under one sine.},
}

@article{makris-konstantinidis-2003,
  author = {Makris, Nicos and Konstantinidis, Dimitrios},
  title = {The rocking spectrum and the limitations of practical design methodologies},
  journal = {Earthquake Engineering and Structural Dynamics},
  volume = {32}, number = {2}, pages = {265--289}, year = {2003},
  annote = {Rocking spectra.},
}

@book{guckenheimer-holmes-1983,
  author = {Guckenheimer, John and Holmes, Philip},
  title = {Nonlinear oscillations, dynamical systems, and bifurcations of vector fields},
  publisher = {Springer}, address = {New York}, year = {1983},
  annote = {Melnikov's method.},
}

@article{benettin-1980,
  author = {Benettin, Giancarlo and Galgani, Luigi and Giorgilli, Antonio and Strelcyn, Jean-Marie},
  title = {Lyapunov characteristic exponents for smooth dynamical systems and for {Hamiltonian} systems;
    a method for computing all of them. {Part} 1: theory},
  journal = {Meccanica},
  volume = {15}, pages = {9--20}, year = {1980},
  doi = {10.1007/BF02128236},
  annote = {Lyapunov exponents from repeatedly orthonormalised tangent vectors.},
}

@article{grassberger-procaccia-1983,
  author = {Grassberger, Peter and Procaccia, Itamar},
  title = {Measuring the strangeness of strange attractors},
  journal = {Physica D},
  volume = {9}, pages = {189--208}, year = {1983},
  doi = {10.1016/0167-2789(83)90298-1},
  annote = {Correlation dimension.},
}

@article{theiler-1986,
  author = {Theiler, James},
  title = {Spurious dimension from correlation algorithms applied to limited time-series data},
  journal = {Physical Review A},
  volume = {34}, pages = {2427--2432}, year = {1986},
  doi = {10.1103/PhysRevA.34.2427},
  annote = {Exclusion of pairs of points that are close in time.},
}

@article{das-2017,
  author = {Das, Suddhasattwa and Saiki, Yoshitaka and Sander, Evelyn and Yorke, James A.},
  title = {Quantitative quasiperiodicity},
  journal = {Nonlinearity},
  volume = {30}, pages = {4111--4140}, year = {2017},
  doi = {10.1088/1361-6544/aa84c2},
  annote = {Weighted Birkhoff averages.},
}

@article{mcdonald-1985,
  author = {McDonald, Steven W. and Grebogi, Celso and Ott, Edward and Yorke, James A.},
  title = {Fractal basin boundaries},
  journal = {Physica D},
  volume = {17}, pages = {125--153}, year = {1985},
  doi = {10.1016/0167-2789(85)90001-6},
  annote = {Uncertainty exponent of a basin boundary.},
}

@article{wilson-1927,
  author = {Wilson, Edwin B.},
  title = {Probable inference, the law of succession, and statistical inference},
  journal = {Journal of the American Statistical Association},
  volume = {22}, number = {158}, pages = {209--212}, year = {1927},
  doi = {10.1080/01621459.1927.10502953},
  annote = {Confidence interval of a fraction.},
}
"""


def cite() -> str:
    """Return BibTeX entries for this package and for the sources of its equations.

    Returns
    -------
    str
        Entries separated by blank lines. The field `annote` states what each source is used for.

    Examples
    --------
    >>> import rocking as rk
    >>> print(rk.cite().splitlines()[0])
    @software{rocking,
    """
    return PACKAGE.format(version=VERSION) + "\n\n" + SOURCES
