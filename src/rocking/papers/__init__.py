"""Papers reproduced with the public names alone: one folder for each report, and `report` for what they share."""
