"""What milling cycles of several controls do: pockets and slots, studs, faces, threads."""
