"""What a cut did and must not do, noted by the line of the program."""
