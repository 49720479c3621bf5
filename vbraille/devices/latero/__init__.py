"""The Latero, a laterotactile display of 8 × 8 blades on the network: its client.

`datagrams` has what goes over the network, `numbering` tells a late answer from a new one, `arms`
where the display is, `conversation` what to say when: none of them has a socket or a clock.
`laterodevice` gives them both, `openlatero` begins, and `guardian` is a process of its own that
brings the blades to rest when this one falls silent.
"""
