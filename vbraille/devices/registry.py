"""Device specs such as ``sim:`` to devices; further kinds join by entry points."""
