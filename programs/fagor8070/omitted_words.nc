%OMITTED
N10 G90 G17 S3000 M03
N20 G00 R30 Q0 Z5                (X30 Y0)
N30 G01 Z-1 F300
N40 Q45 F1200                    (R stays 30: X21.213 Y21.213)
N50 R50                          (Q stays 45: X35.355 Y35.355)
N60 G03 Q135                     (R stays 50, centre is the polar origin: X-35.355 Y35.355)
N70 G01 R30                      (Q stays 135: X-21.213 Y21.213)
N80 X-30 Y0                      (a Cartesian move)
N90 G03 Q270                     (R is that of the point, 30: X0 Y-30)
N100 G01 R50                     (X0 Y-50)
N110 G03 Q0                      (X50 Y0)
N120 G01 R30                     (X30 Y0)
N130 G00 Z50 M05
N140 M30
