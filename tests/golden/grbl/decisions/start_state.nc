X5 (G0 is in force)
G1 Y5 (no feed)
