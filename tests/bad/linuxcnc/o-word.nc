o100 loop [3]
M2
