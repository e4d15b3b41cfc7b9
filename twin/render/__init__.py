"""Pictures of a recording. The only package that uses OpenGL."""
