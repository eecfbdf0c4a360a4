"""Measurements at the points of a survey."""
