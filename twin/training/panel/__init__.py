"""The operator panel in Dear ImGui: a picture of a snapshot that gives back what was asked for."""
