#<own> = 1
G30 Z5
M2
