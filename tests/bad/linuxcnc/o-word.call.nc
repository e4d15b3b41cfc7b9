o<hole> sub
G0 Z1
o<hole> endsub
o<hole> [1] [2]
M2
