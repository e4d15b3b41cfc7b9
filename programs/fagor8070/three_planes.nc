%PLANES
N10 G90 G17 S3000 M03
N20 G00 X-40 Y-20 Z5
N30 G01 Z0 F300
N40 G18 G02 X40 Z0 R85 F1200     (Z X, seen from +Y: dips to Z-10)
N50 G01 Y20
N60 G30 I75 J0                   (polar origin at Z75 X0, above the part)
N70 G03 Q208.072487              (R stays 85: ends Z0 X-40)
N80 G19 G02 Y-20 Z0 J-20 K48     (Y Z, seen from +X: dips to Z-4)
N90 G17 G00 Z50 M05
N100 M30
