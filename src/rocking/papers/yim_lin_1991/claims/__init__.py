"""All claims and numbers of the paper, each with the computation that tests it."""
