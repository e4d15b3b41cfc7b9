#1=0
o100 while [#1 LT 2]
#1=[#1+1]
o100 endwhile X5
M2
