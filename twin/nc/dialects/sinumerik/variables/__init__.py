"""Variables and expressions of the SINUMERIK."""
