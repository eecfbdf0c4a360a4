"""Page of ground motions: a record or pulse, blocks of many sizes under it, and the motion of one of them."""

from rocking.explorer.ground_motion.page import page
from rocking.explorer.ground_motion.session import GroundSession

__all__ = ["GroundSession", "page"]
