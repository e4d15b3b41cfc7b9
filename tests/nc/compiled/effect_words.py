"""Blocks that do more than move and compute, by dialect, for programs that are made at random."""

EFFECTS = {
    "fagor8070": (
        "G4 K1|G04 0.5|#TIME [P1]|#TIME[1]|M8|M5 M9|S[P1*10] M3|S1000|M3|M4 S5 M8|T1|"
        "T2 M6|M6|T[P1] M6|D0|D1|H5|G54|G55|G55 X3|G56 G0 Z[P1]|G53|G92 X[P1] Y3|"
        "G92 X1 Y2 Z3 C4|G158 X[P1] Y1|G158|G70 G158 X1|G70 G92 Y1|G71|G17|G18|G19|"
        "G17 G0 X1|R5 Q30|R[ABS[P1]] Q[P2]|G90 R3 Q[P1*9]|G91 R1|G90 Q45 F50|"
        "R7 Z3 Q[P1*10]|G30|G30 I[P1] J2|G0 R5 Q10|G90 G1 R5 Q0|G1 R4 Q-90|G2 R5 Q90|"
        "G73 Q30|G73|G11|G10|G95 F0.1|G94 F100|G93 F3|G61 X3|G81 Z2 I-5 K1|G80|"
        "G83 Z1 I2 J3|G91 G85 Z1 I-3|X[P1] Y3|R5 Q[P1]|Q[P2*9]|G98|G99|"
        "G84 Z3 I-[ABS[P1]]|G82 Z1 I-9 B2 L1 H1 J2|X5 Y5|G1"
    ),
    "codesys": (
        "G4 T(#a)|G4 T1|M8 M9|M8 K2|M8|M77|G54 X(#a) Y1|G54 Z3|G55 X2|G53|G56 X1 Y(#b)|"
        "G17|G18|G19|G15|G92 X3|G41 D2|G40|G51 D1|G50|G1"
    ),
    "mefi": (
        "G4 P1|G4 X2|G4 F3|S100 M3|S500|M4|M3 M8|M9 M5|T1|T2 M6|M6|T1 M6 S3 M3|G54|"
        "G55 X5|G56|G53|G92 X3|G92 X1 Y2|G70 G92 X1|G71|G43 H2|G49|G43 H9|G44 H2 Z5|"
        "G43|G17|G18|G19|M0|G81 Z-2 R1|G80|X5 Y3|G83 Z-9 R1 Q2|G82 X1 Z-3 R1 P2|"
        "G85 Z-3 R1|Z-4|G91 G81 Z-5 R-1|G90|G95|G94|G1"
    ),
}
"""Separated by bars."""
