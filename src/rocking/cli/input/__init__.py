"""Conversion of options and study files to the arguments of public functions."""
