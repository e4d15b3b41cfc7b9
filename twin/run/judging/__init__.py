"""The judgement of a run: warnings, the scope of its verdict, and the outcome."""
