o<nowhere> call
M2
