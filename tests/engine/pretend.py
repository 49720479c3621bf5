"""The example controller for Linux, compiled and run at a pseudo-terminal."""

import os
import subprocess
import time
from contextlib import contextmanager
from pathlib import Path

FIRMWARE = Path(__file__).parents[2] / "firmware"


@contextmanager
def pretend(folder: Path, *flags: str, path: str = ""):
    """Run it; gives the spec of the device, and the path of its trace."""
    binary = folder / "device"
    command = ["cc", "-std=gnu99", "-Wall", "-Wextra", "-Werror", "-O1", "-DTRACE", *flags]
    source = str(FIRMWARE / "example" / "main.c")
    subprocess.run([*command, f"-I{FIRMWARE}", source, "-lm", "-o", str(binary)], check=True)
    port, trace = folder / "port", folder / "trace"
    with trace.open("w") as out:
        # A real controller has a processor of its own: this one comes first.
        first = ["chrt", "-f", "45"] if os.geteuid() == 0 else []
        command = [*first, str(binary), str(port), *([path] if path else [])]
        process = subprocess.Popen(command, stdout=out)
        try:
            until_s = time.monotonic() + 5
            while not port.exists() and time.monotonic() < until_s:
                time.sleep(0.01)
            yield f"serial:{port}", trace
        finally:
            process.kill()
            process.wait()


def traced(trace: Path) -> list[list[int]]:
    """Rows of the trace: time in µs, highest level, number taken, whether a FRAME holds it."""
    lines = trace.read_text().splitlines()[:-1]
    return [[int(number) for number in line.split()] for line in lines]
