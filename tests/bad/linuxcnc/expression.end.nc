o1 do
G0 X1
o1 break
o1 while [#1 LT 3
M2
