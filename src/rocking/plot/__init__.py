"""Pictures: one file a kind; each takes a result and an Axes, and returns the Axes.

Units, labels, colours and sizes are set here and nowhere else; the user's matplotlib settings stay as they are.
"""

from rocking.model import pictures
from rocking.motion import Motion
from rocking.plot.animation import animation
from rocking.plot.overview import overview, png
from rocking.plot.phase_portrait import phase_portrait
from rocking.plot.save import save
from rocking.plot.schematic import schematic
from rocking.plot.section import section
from rocking.plot.style import panels, title
from rocking.plot.time_history import time_history

__all__ = [
    "animation",
    "overview",
    "panels",
    "phase_portrait",
    "save",
    "schematic",
    "section",
    "time_history",
    "title",
]

pictures.hang(Motion, png)
