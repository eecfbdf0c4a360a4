"""The run of a survey: its tiles, their cost, progress, and the loop over them."""
