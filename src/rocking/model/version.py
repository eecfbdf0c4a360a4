"""Version of the package, the only definition."""

VERSION = "0.1.0"
