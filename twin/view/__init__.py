"""A recorded run on a page: played, scrubbed, by line, with its contour error and the part as cut."""
