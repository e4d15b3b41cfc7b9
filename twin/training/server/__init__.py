"""The server: its doors and its page."""
