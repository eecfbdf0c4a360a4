"""Plot functions: each takes a result and an Axes, and returns the Axes.

Units, labels, colours and sizes are set in this package only. The user's matplotlib settings stay unchanged.

A function is imported on first use. The names stand in `__init__.pyi`.

Without an Axes, a function makes a figure, which a notebook shows. In a script that has imported `matplotlib.pyplot`, the figure
belongs to pyplot: `plt.show` shows it, and it stays open until `plt.close`.
"""

from rocking.model.public_names import lazy

__getattr__, __dir__, __all__ = lazy(__name__)
