"""A session: the room, and what is done in it."""
