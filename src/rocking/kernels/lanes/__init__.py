"""Many blocks at once, one in each lane of the vector registers."""
