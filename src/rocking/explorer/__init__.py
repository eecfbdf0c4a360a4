"""Interactive explorer in the browser, served by `rocking explore`."""

from rocking.model.package import require_extra

require_extra("explorer")
from rocking.explorer.application import serve  # noqa: E402 (its packages are optional)

__all__ = ["serve"]
