G0 X1
#WARNING["clamp the part"]
M30
