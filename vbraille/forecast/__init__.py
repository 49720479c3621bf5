"""Forecasts of a study before it begins: power, pilots, and maps of predictions.

`workers` spreads work over processes. `power` simulates studies of a protocol's own design and
analysis; `pilots` conducts its sessions with the simulated reader; `grids` asks the simulated
reader about a grid of styles, texts and speeds. Nothing made here is data about people.
"""
