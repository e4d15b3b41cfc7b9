%
O<PLATE-1> (BY ITS NAME)
; made by hand
G21 G90 G54;
;
G1 X10. F100.;
Y5.; (TO THE WALL)
X0.; back, 5 mm above it
M30;
%
