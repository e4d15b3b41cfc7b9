G0 X#<depth>
M2
