"""Recordings played back in the live view.

`open_recording` makes a source for `vbraille.live.server.Server` of a file of `vbraille render`.
What plays sessions back stands in `vbraille.sessions`, as another `Playback`.
"""
