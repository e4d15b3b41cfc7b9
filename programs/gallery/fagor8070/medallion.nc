%MEDALLION
(A bore by a helix, a scroll of polar arcs, and a rim that the turning table cuts.)
N10 G90 G17 S6000 M03
N20 G00 X12 Y0 Z3 C0
(eight turns down to Z-8)
N30 G01 Z0 F600
N40 G03 X12 Y0 Z-8 I-12 J0 K1 F2400
N50 G00 Z3
(half circles that end at R and Q about X0 Y0)
N60 G00 R28 Q0
N70 G01 Z-2.5 F400
N80 G03 R34 Q180 I-31 J0 F2400
N90 R40 Q0 I37
N100 R46 Q180 I-43
N110 R52 Q0 I49
N120 G00 Z3
(waves: X swings while C turns)
N130 G00 X66 Y0
N140 G01 Z-3 F400
$FOR P1 = 1, 120, 1
  G01 X[66 + 4 * SIN[30 * P1]] C[3 * P1] F3600
$ENDFOR
N150 G00 Z50 M05
N160 M30
