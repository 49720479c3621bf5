"""The Latero, a laterotactile display of 8 × 8 blades on the network: its client.

`wire` has what goes over the network, `device` what is said when, and `watchdog` is a process of
its own that brings the blades to rest, whatever the reason.
"""
