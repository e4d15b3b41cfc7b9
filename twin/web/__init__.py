"""Web pages of our own: who may come in, the server, the view of a machine in three dimensions."""
