"""What the tests start finds the same, however the tests were started."""

import json
import os
import signal
import subprocess
import sys

FOUND = (
    "import json, os; status = dict(line.split(':', 1) for line in open('/proc/self/status')); "
    # Two signals are the C library's own (32, 33); what make starts has them ignored.
    "print(json.dumps([int(status['SigIgn'], 16) & ~(3 << 31), int(status['SigBlk'], 16), "
    "os.umask(0), dict(os.environ)]))"
)
# As the tests begin, and then start a process; which is started by a shell, as any is.
STARTS = (
    "import tests.conftest, subprocess, sys; "
    "subprocess.run([sys.executable, '-c', sys.argv[1]], check=True)"
)
PYTHON_IGNORES = 1 << signal.SIGPIPE - 1 | 1 << signal.SIGXFSZ - 1
STRANGE = 'umask 077; trap "" HUP INT QUIT ALRM TERM TSTP; exec "$@"'


def found(shell, **environment):
    done = subprocess.run(
        ["sh", "-c", shell, "sh", sys.executable, "-c", STARTS, FOUND],
        env={"PATH": os.environ["PATH"], "HOME": os.environ.get("HOME", "/")} | environment,
        stdin=subprocess.DEVNULL, capture_output=True, check=True,
    )  # fmt: skip
    *seen, given = json.loads(done.stdout)
    return seen, {name: value for name, value in given.items() if name not in ("PWD", "OLDPWD")}


def test_a_process_finds_no_signal_ignored_no_mask_and_no_wish_of_somebody():
    strange = found(
        STRANGE, VBRAILLE_TRACEBACK="1", PYTHONUNBUFFERED="1", COLUMNS="20",
        SSH_CONNECTION="elsewhere", LC_ALL="C", TERM="dumb",
    )  # fmt: skip
    assert strange == found('exec "$@"')
    assert strange[0] == [PYTHON_IGNORES, 0, 0o022]


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
