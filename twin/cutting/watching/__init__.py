"""Records of a cut, by program line: what it removed, and what it must not do."""
