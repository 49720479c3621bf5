"""The current validator of BIDS, which looks into the files, too."""

import subprocess
import sys
from pathlib import Path

_VALIDATOR = Path(sys.executable).with_name("bids-validator-deno")


def complaints(folder):
    """What the validator has against a dataset, in its words; empty if nothing."""
    done = subprocess.run(
        [_VALIDATOR, "--ignoreWarnings", folder], check=False, capture_output=True, text=True
    )
    return "" if done.returncode == 0 else done.stdout + done.stderr
