"""What runs when: structures and jumps, the programs of a text, calls, blocks that run again."""
