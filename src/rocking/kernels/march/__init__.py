"""March of one block from event to event."""
