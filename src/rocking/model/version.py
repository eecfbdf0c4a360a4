"""The version of the package, in the one place that is read by all."""

VERSION = "0.1.0"
