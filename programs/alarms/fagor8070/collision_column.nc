%COLLISION_COLUMN
(The stock stands out over the table: line 4 drives it against the column.)
N10 G90 G71 G00 Z50
N20 G01 Y-280 F10000
N30 M30
