%CIRCLES
N10 G90 G17 S3000 M03
N20 G00 X40 Y0 Z5
N30 G01 Z-1 F300
N40 G91 G03 Q360 F1500           (a whole circle about the polar origin: ends X40 Y0)
N50 G90 G01 R25 Q90              (X0 Y25)
N60 G02 Q360                     (to the angle 360 = 0: a quarter, ends X25 Y0)
N70 G91 G01 R-10                 (X15 Y0)
N80 G03 Q90                      (X0 Y15)
N90 Q90                          (X-15 Y0)
N100 G90 Q360                    (to the angle 360 = 0: X15 Y0)
N110 G02 Q360                    (start and end are one point: a whole circle)
N120 G00 Z50 M05
N130 M30
