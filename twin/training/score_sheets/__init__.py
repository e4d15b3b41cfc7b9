"""Score sheets: of one session, and the list of a course."""
