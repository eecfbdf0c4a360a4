"""Papers reproduced with the public names alone; one folder a paper."""
