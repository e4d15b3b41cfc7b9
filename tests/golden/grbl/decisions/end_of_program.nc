%
G0 X5
M30
G0 X9 (not run)
%
