%POLYGON
N10 G90 G17 S3000 M03
N20 G00 X0 Y-40 Z5
N30 G01 Z-2 F300
N40 X25 F1500
N50 G30 I25 J-25                 (middle of the first corner)
N60 G03 R15 Q0                   (centre omitted: the polar origin; ends X40 Y-25)
N70 G01 Y25
N80 G30 I25 J25
N90 G03 Q90                      (R is 15, seen from the new origin; ends X25 Y40)
N100 G01 X-25
N110 G31 G03 Q180 I0 J-15        (G31: Q about the arc's centre; ends X-40 Y25)
N120 G01 Y-25
N130 G30 I0 J0
N140 G03 R47.169906 Q237.994617 I15 J0   (R Q I J; ends X-25 Y-40 within the last digit)
N150 G01 X0 Y-40
N160 G00 Z50 M05
N170 M30
