"""Libraries of the user's own do not change what a program prints."""

import os
import subprocess
import sys

# As the tests begin, and then start a process; which is started by a shell, as any is.


COLORAMA = """
import atexit
def reset_all():
    print("\\x1b[0m")
def init():
    atexit.register(reset_all)
"""


def test_a_library_of_colors_that_numba_begins_does_not_end_the_output(tmp_path):
    (tmp_path / "colorama").mkdir()
    (tmp_path / "colorama" / "__init__.py").touch()
    (tmp_path / "colorama" / "initialise.py").write_text(COLORAMA)
    program = (
        "import colorama.initialise as it, vbraille.cli.app as cli; it.init(); cli.main(['-V'])"
    )
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True
    )
    assert done.stdout.startswith("vbraille ")
    assert "\x1b" not in done.stdout
