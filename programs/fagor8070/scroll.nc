%SCROLL
N10 G90 G17 S3000 M03
N20 G00 X10 Y0 Z5
N30 G01 Z-1.5 F300
N40 G03 R20 Q180 I-15 J0 F1500   (centre X-5: ends X-20 Y0)
N50 R30 Q0 I25                   (J omitted is 0; centre X5: ends X30 Y0)
N60 R40 Q180 I-35                (centre X-5: ends X-40 Y0)
N70 R50 Q0 I45                   (centre X5: ends X50 Y0)
N80 R60 Q180 I-55                (centre X-5: ends X-60 Y0)
N90 Q0                           (R stays 60, centre is the polar origin: ends X60 Y0)
N100 G00 Z50 M05
N110 M30
