"""The classification of a response, from recurrence to the verdict."""
