o100 if [1]
o100 endif
o100 if [2]
o100 endif
M2
