"""Levels packed as the protocol's page says, in plain integers: the twin of the compiled code."""


def packed(levels, top_level):
    """Bytes of levels, each in as few bits as the highest one takes, the first bit foremost."""
    bits = int(top_level).bit_length()
    number = 0
    for level in levels:
        number = number << bits | int(level)
    left_over = -len(levels) * bits % 8
    return (number << left_over).to_bytes((len(levels) * bits + left_over) // 8, "big")
