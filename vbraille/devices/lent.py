"""What a device lends to the engine, which then does the device's steady ticks in compiled code."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Actuators(NamedTuple):
    """How FRAMEs are made, and the last of them.

    Parameters
    ----------
    last, wanted : float64[rows, columns]
        Deflections of the FRAME that went out last, and of the FRAME that was made last.
    swing : float64[rows, columns]
        Number of levels in a full swing, before it is inverted.
    rest : int64[rows, columns]
        Level at rest: 0, or the highest.
    body : uint8[bytes]
        Type, sequence and levels of a FRAME, and room for its CRC.
    packed : uint8[bytes]
        View of the levels in ``body``.
    """

    last: NDArray[np.float64]
    wanted: NDArray[np.float64]
    swing: NDArray[np.float64]
    rest: NDArray[np.int64]
    body: NDArray[np.uint8]
    packed: NDArray[np.uint8]


class Lent(NamedTuple):
    """What a device lends to the engine, which then does its steady ticks in compiled code.

    Parameters
    ----------
    descriptor
        Descriptor of the device's open line, which does not block.
    begun
        Number of bytes at the beginning of `received`: a part of a message.
    received, work, out : uint8[bytes]
        Bytes that have come, room to work in, and room for a message that goes out.
    talk, actuators
        Numbers of the conversation, `vbraille.devices.serial.steady.CONVERSATION`[1], and how its
        FRAMEs are made.
    """

    descriptor: int
    begun: int
    received: NDArray[np.uint8]
    work: NDArray[np.uint8]
    out: NDArray[np.uint8]
    talk: NDArray[np.void]
    actuators: Actuators
