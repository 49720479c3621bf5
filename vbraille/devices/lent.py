"""What a device lends to the engine, which then does the device's steady ticks in compiled code."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Actuators(NamedTuple):
    """What FRAMEs are made with, and the last of them.

    Parameters
    ----------
    last, wanted : float64[rows, columns]
        Deflections of the FRAME that went out last, and of the one that was made last.
    swing : float64[rows, columns]
        Levels of a full swing, before it is inverted.
    rest : int64[rows, columns]
        Level at rest: 0, or the highest.
    body : uint8[bytes]
        A FRAME's type, sequence and levels, and room for its CRC.
    packed : uint8[bytes]
        The levels, in it.
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
        The descriptor of the device's open line, which does not block.
    begun
        Bytes that `received` begins with: a part of a message.
    received, work, out : uint8[bytes]
        What has come; room to work in, and for a message that goes out.
    talk, actuators
        The numbers of the conversation, `vbraille.devices.serial.steady.CONVERSATION`[1], and
        what its FRAMEs are made with.
    """

    descriptor: int
    begun: int
    received: NDArray[np.uint8]
    work: NDArray[np.uint8]
    out: NDArray[np.uint8]
    talk: NDArray[np.void]
    actuators: Actuators
