"""Stock as a height map: swept by tools, coloured, and closed to the mesh of the part."""
