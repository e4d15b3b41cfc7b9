"""What commands do with a program that is not run: first job, check, moves, plan."""
