"""The live view: a page in a browser that shows a reading, a session or a recording, and steers.

`vbraille.live.view.LiveView` serves what is read now, and `vbraille.live.server.Server` any source.
"""
