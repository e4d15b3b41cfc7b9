"""What the dialects share of ISO 6983: codes, cycles, offsets."""
