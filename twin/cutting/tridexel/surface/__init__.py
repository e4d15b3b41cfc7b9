"""The surface of a tri-dexel stock: as a mesh, and against another's."""
