"""A recording, a tool and a stock to the machined part. Knows nothing of G-codes."""
