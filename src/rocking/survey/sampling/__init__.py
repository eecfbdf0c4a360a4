"""Where the points of a survey lie, when they are not on a grid."""
