"""How a survey is run: its tiles, their cost, progress, and the loop over them."""
