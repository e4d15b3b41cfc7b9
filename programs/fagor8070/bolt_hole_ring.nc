%BOLTRING
N10 G90 G17 T1 S3000 M03
N20 G00 X0 Y0 Z5
N30 G30 I10 J20            (polar origin at the middle of the ring)
N40 G00 R40 Q0             (first hole: X50 Y20)
N50 G01 Z-6 F300
N60 G00 Z5
N70 Q60                    (R stays 40: X30 Y54.641)
N80 G01 Z-6
N90 G00 Z5
N100 Q120                  (X-10 Y54.641)
N110 G01 Z-6
N120 G00 Z5
N130 G91 Q60               (incremental: Q180, X-30 Y20)
N140 G90 G01 Z-6
N150 G00 Z5
N160 Q240                  (X-10 Y-14.641)
N170 G01 Z-6
N180 G00 Z5
N190 Q-60                  (Q-60 is Q300: X30 Y-14.641)
N200 G01 Z-6
N210 G00 Z50 M05
N220 M30
