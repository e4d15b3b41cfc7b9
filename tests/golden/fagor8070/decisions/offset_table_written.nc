; G54 is the first of the table, from machine zero; it holds from the next G54 on
G54 G00 X0 Z0
V.A.ORGT[1].Z=-190
X1 Z0
G54 X1 Z0
P1=V.A.ORGT[1].Z
X=P1
V.A.ORGT[2].X=7 V.A.ORGT[2].Y=8 G159=2
X0 Y0
M30
