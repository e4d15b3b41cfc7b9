#1=0
o1 do
#2=0
o2 while [#2 LT 2]
#2=[#2+1]
o3 if [#2 GT 1]
o2 break
o3 endif
o2 endwhile
G91 G0 X1
#1=[#1+1]
o1 while [#1 LT 3]
M2
