"""Points of a survey that are not on a grid."""
