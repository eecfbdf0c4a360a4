"""Points of a survey that do not lie on a grid."""
