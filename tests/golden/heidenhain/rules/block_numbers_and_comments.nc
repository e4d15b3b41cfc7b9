BEGIN PGM BLOCK_NUMBERS_AN MM
0  BEGIN PGM NUMBERS MM
1  ; a comment that goes ~
on in the next line
2  * - heading of the structure
3  TOOL CALL 2 Z S1000
4  L  X+1  Y+2 R0 F100 M13 ; words
/5 L X+3
6 /L X+4
N70 L X+5
8  M9 M5
9  L R F M
10 STOP M8
11 END PGM NUMBERS MM
END PGM BLOCK_NUMBERS_AN MM
