"""The commands: each module holds one as ``command``, and is loaded when that is called."""
