"""Drawings for tests, and what became of them."""

NS = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'


def element_of(found):
    (element,) = found.scene.elements
    return element


def warned(found):
    return [warning.split(": ", 1)[1] for warning in found.warnings]
