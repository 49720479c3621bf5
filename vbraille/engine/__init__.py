"""Time: the loop that reads the device, renders and writes, tick by tick.

`host` runs it in a process of its own, and is imported without it.
"""
