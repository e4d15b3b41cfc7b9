%ROSETTE
(A rosette cut by the turning table: X swings while C turns.)
N10 G90 G17 G61
(rim: C alone turns, the tool stands at X72)
N20 T1 M06
N30 S4000 M03
N40 G00 X72 Y0 C0 Z3
N50 G01 Z-4 F400
N60 G01 C360 F3600
N70 G00 Z20
(three interlaced waves of ten petals)
N80 T2 M06
N90 S8000 M03
$FOR P1 = 0, 2, 1
  $FOR P2 = 0, 360, 1
    P3 = 44 + 15 * COS[10 * P2 + 120 * P1]
    $IF P2 == 0
      G00 X[P3] C[360 + 360 * P1]
      Z3
      G01 Z-1.2 F400
    $ELSE
      G01 X[P3] C[360 + 360 * P1 + P2] F3600
    $ENDIF
  $ENDFOR
  G00 Z3
$ENDFOR
(a ring of holes around the middle)
N200 T3 M06
N210 S3000 M03
N220 G00 X18 Z3
$FOR P1 = 0, 7, 1
  G00 C[1440 + 45 * P1]
  G01 Z-8 F400
  G00 Z3
$ENDFOR
N230 G00 Z50 M05
N240 M30
