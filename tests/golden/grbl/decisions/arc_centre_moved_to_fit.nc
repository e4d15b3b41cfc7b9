G91 G2 X20.004 Y0 I10 F300 (0.004 mm beside)
G2 X20.1 Y0 I10 (0.1 mm beside)
