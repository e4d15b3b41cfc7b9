"""Canned cycles of Fanuc controls: drilling and tapping, boring, bolt holes."""
