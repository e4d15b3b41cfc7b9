LET x
