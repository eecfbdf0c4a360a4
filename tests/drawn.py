"""What is drawn into axes."""

import numpy as np


def artists(ax, gid):
    """Return the artists with this identifier."""
    return [child for child in ax.get_children() if child.get_gid() == gid]


def artist(ax, gid):
    """Return the only artist with this identifier."""
    (found,) = artists(ax, gid)
    return found


def points(ax, gid):
    """Return the points of the only line with this identifier, in rows."""
    return np.column_stack(artist(ax, gid).get_data())


def legend(ax):
    """Return the texts of the legend."""
    return [text.get_text() for text in ax.get_legend().get_texts()]
