"""A session: the room, what is done in it, its score."""
