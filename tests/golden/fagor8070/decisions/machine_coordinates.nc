; one block, then a range; tool and offset act again behind them
T2 D1 M06
G54 G00 X5 Y5 Z10
#MCS G00 Z-20
X0 Y0
#MCS ON
G01 X1 Y2 Z-30 F500
G91 X3
G90
#MCS OFF
X0 Z10
M30
