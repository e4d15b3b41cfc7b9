"""What draws a MuJoCo model: OpenGL or Filament."""
