"""The march of one block from event to event."""
