"""What a trainee's work was worth: tasks and their conditions, alarms, the finished part."""
