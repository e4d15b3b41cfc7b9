"""Web pages: access control, the server, the view of a machine in three dimensions."""
