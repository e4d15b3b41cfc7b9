"""A scene: its file, tasks and texts."""
