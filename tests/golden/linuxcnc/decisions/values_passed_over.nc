o<half> sub
o<half> return [1 / #1]
o<half> endsub
o<half> call [2]
G0 X#<_value>
M2
