"""What a plan tells a person."""
