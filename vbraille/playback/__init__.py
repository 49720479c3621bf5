"""Recordings and sessions played back in the live view.

`open_recording` makes a source for `vbraille.live.server` of a file of `vbraille render`, of a
session's directory or of one of its traces. Any frame can be asked for at any time: a `Reel` gives
frames by the piece, and a `Playback` keeps the pieces that were asked for last.
"""

from vbraille.playback.opening import open_recording

__all__ = ["open_recording"]
