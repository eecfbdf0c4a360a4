"""The motion of the base: its forcing term, its response and its changes of sign."""
