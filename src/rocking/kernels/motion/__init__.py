"""Motions from event to event: the march, what is recorded of it, tangent vectors, and motions to their end."""
