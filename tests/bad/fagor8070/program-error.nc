G0 X1
#ERROR["no blank in the vise"]
