"""Grbl's line protocol: senders stream a program to the twin as to a machine."""
