"""What a reader has chosen once and for all: a TOML file of defaults, keys and profiles.

`vbraille.settings.values` reads it, `vbraille.settings.saving` writes a profile into it, and
`vbraille.settings.origins` tells where each value comes from.
"""
