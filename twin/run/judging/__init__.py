"""What a run came to: warnings, the scope of its verdict, and the outcome."""
