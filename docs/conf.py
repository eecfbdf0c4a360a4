"""How the pages are made: `make docs`."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "extensions"))

from rocking import __version__  # noqa: E402

project = "rocking"
author = "The rocking authors"
copyright = "2026, The rocking authors"  # noqa: A001
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # MathJax in the pages themselves, asked of no other host
    "numpydoc",
    "bars",
    "checked",
    "executed",
    "seen",
]
exclude_patterns = ["images"]
default_role = "literal"
smartquotes = False  # Θ' is a derivative

myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 3

autodoc_preserve_defaults = True
autodoc_typehints = "none"
autodoc_member_order = "bysource"
numpydoc_show_class_members = False

html_theme = "furo"
html_title = f"rocking {release}"
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_copy_source = False
html_show_sphinx = False
