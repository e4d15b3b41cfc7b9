"""Beside the helpers of these tests, so that those in the folders below find them."""
