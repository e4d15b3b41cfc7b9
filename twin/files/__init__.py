"""Reading and writing files: atomically, TOML, STL, what is shipped."""
