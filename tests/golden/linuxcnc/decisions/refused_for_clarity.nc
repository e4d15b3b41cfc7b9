o100 if [0]
o100 elseif [0] P1
o100 endif
M2
