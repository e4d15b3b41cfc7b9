"""How a raw program is read: its dialect, its numbers, its tools, as far as its text tells them."""
