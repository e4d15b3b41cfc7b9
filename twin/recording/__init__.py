"""The recording: its form, its writer, its reader."""
