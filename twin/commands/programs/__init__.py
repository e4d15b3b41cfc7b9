"""Commands on programs: first job, check, moves, plan."""
