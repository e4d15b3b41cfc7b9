"""The job file: what runs where, with which stock, tools and tolerances."""
