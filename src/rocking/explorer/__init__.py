"""Interactive explorer in the browser, served by `rocking explore`."""
