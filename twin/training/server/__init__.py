"""The server: the machine's thread, what pages are sent, who may do what."""
