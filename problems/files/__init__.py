"""Values as files: TOML and JSON read, checked and written, and the catalogues."""
