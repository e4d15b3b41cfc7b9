o100 repeat [3]
o100 break
o100 endrepeat
M2
