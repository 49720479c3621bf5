"""Devices made of software: hands and what moves them, controllers, and what goes wrong in them.

A device in memory (`vbraille.simulation.simulated`) keeps the interface of every other device; a
simulated controller (`vbraille.simulation.simulator`) speaks the wire behind a pseudo-terminal.
What a hand does there that no person's hand does, such as setting out when it is told to, is
between it and its caller (`vbraille.simulation.steering`): no engine and no other device
knows of it.
"""
