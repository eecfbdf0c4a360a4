"""Run of a survey: cost estimate, progress and the loop over its tiles."""
