G20 G1 X1 F10
G21 X30 (the feed stays 254 mm/min)
