"""The Latero, a laterotactile display of 8 × 8 blades on the network: its client.

`wire` has what goes over the network, `conversation` what to say when; neither has a socket or a
clock. `device` gives them both, and `watchdog` is a process of its own that brings the blades to
rest when the client falls silent.
"""
