%COLLISION_GANTRY
(A tall block beside the spindle: line 4 drives the gantry's beam against it.)
N10 G90 G71 G00 X-100 Y0
N20 G01 Y-150 F3000
N30 M30
