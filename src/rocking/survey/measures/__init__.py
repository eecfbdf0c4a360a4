"""What is computed at the points of a survey."""
