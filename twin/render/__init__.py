"""Pictures of a recording. The only room that touches OpenGL."""
