(Two letters of a function's name suffice, and WH for WHILE)
G21 G90 G17 G40 G80
#1=RO[2.5]+FI[3.7]+FU[3.2]
#2=AB[-2.]*SQ[9.]
#3=AT[1.]/[1.]
G1 X#1 Y#2 F1000
G1 Z-[SI[30.]+CO[60.]] C#3
#4=3.
WH[#4 GT 0] DO1
G1 X#4
#4=#4-1.
END1
M30
