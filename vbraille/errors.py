"""Everything that vbraille tells a user it cannot do.

The message is one sentence that says what to do. `main` prints it on stderr
and leaves with ``exit_code``; a traceback reaches nobody.
"""


class VbrailleError(Exception):
    """A fault at run time: a device, a disk, a library."""

    exit_code = 1


class InputError(VbrailleError):
    """The user gave something that cannot be used."""

    exit_code = 2


class DeviceError(VbrailleError):
    """A device did not do what it was asked, or was asked what it must not do."""
