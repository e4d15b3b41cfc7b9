"""Assessment of a trainee: tasks and their conditions, alarms, the finished part."""
