"""The version of this package, which recordings carry."""

__version__ = "0.1.0"
