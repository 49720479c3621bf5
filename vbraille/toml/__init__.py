"""TOML files that people write: read into values, or into a sentence that names the line."""
