G0 X1 (no end
M2
