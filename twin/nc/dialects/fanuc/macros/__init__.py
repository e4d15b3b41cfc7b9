"""Custom macro B: variables, expressions and program flow."""
