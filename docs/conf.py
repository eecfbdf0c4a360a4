"""Configuration of Sphinx, which builds the pages: `make docs`."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "extensions"))

from numpydoc.xref import DEFAULT_LINKS  # noqa: E402

import rocking  # noqa: E402

project = "rocking"
author = "The rocking authors"
copyright = "2026, The rocking authors"  # noqa: A001
version = release = rocking.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx.ext.viewcode",
    "sphinx-mathjax-offline",  # MathJax is part of the pages: no request to another host
    "numpydoc",
    "sphinx_copybutton",
    "attrs_signatures",
    "bars",
    "checked",
    "commands",
    "executed",
    "names",
    "report",
    "seen",
    "stated",
    "thumbnails",
]
exclude_patterns = ["images"]
default_role = "py:obj"  # a public name in a docstring is a link; anything else stays code
smartquotes = False  # Θ' is a derivative

notebooks = ["notebook"]  # pages whose blocks are run as the cells of a notebook

myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 3

copybutton_selector = "div:not(.printed) > div.highlight > pre"  # what one types, not what is printed
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

autodoc_preserve_defaults = True
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autosummary_generate = False
numpydoc_show_class_members = False

# Public classes in the types of parameters and results are links. The words that numpydoc would link to the pages of other
# projects stay words, because such links need the network when the pages are built.
numpydoc_xref_param_type = True
numpydoc_xref_ignore = "all"
numpydoc_xref_aliases = (
    {word: word for word in DEFAULT_LINKS}
    | {name: f"rocking.{name}" for name in rocking.__all__ if isinstance(getattr(rocking, name), type)}
    | {name: f"{module}.{name}" for module, names in rocking._MOVED.items() for name in names.split()}
)

html_theme = "furo"
html_title = f"rocking {release}"
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_copy_source = False
html_show_sphinx = False
