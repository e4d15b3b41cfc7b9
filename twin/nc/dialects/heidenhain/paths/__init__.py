"""Path functions of Klartext: moves, the corners between them, and leads."""
