"""What is wrong with a program: diagnostics, what they mean, and what was meant instead."""
