G0 X1 (a comment that fills the line a comment that fills the line a comment that fills the line a comment that fills the line a comment that fills the line a comment that fills the line a comment that fills the line a comment that fills the line a co)
M2
