"""Classification of a response, from its recurrence to the verdict."""
