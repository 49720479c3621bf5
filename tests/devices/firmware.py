"""The controller's header, compiled by the system's compiler and called from Python."""

import ctypes
import subprocess
from functools import cache
from pathlib import Path

import numpy as np

FIRMWARE = Path(__file__).parents[2] / "firmware"
_HARNESS = r"""
#include "vbraille.h"
static uint8_t sent[256];
static int sent_bytes, room = 1;
static uint16_t driven[VB_N];
uint8_t vb_send(const uint8_t *bytes, uint8_t count) {
  if (!room) return 0;
  memcpy(sent, bytes, count); sent_bytes = count; return 1;
}
void vb_drive(const vb_level *levels) { for (int i = 0; i < VB_N; i++) driven[i] = levels[i]; }
void hear(const uint8_t *bytes, int count) { while (count--) vb_byte(*bytes++); }
int tick(uint32_t us, int32_t x, int has_room, uint8_t *out, uint16_t *levels) {
  vb_input seen; memset(&seen, 0, sizeof seen);
  seen.x = x; seen.y = 2 * x; seen.turn = -x;
  sent_bytes = 0; room = has_room;
  vb_tick(us, &seen);
  memcpy(out, sent, sent_bytes); memcpy(levels, driven, sizeof driven);
  return sent_bytes;
}
void say(int code) { vb_say((uint8_t)code, "too hot"); }
/* Ticks with bytes between them; gives the largest step, and the largest while it rests. */
void soak(const uint8_t *bytes, const int32_t *counts, const uint32_t *us, int ticks,
          int32_t *most) {
  uint8_t out[256]; uint16_t levels[VB_N], before[VB_N]; memset(before, 0, sizeof before);
  for (int n = 0; n < ticks; n++) {
    hear(bytes, counts[n]); bytes += counts[n];
    uint8_t resting = vb.resting;
    tick(us[n], n, n % 7 != 0, out, levels);
    resting = resting || vb.resting;
    for (int i = 0; i < VB_N; i++) {
      int step = levels[i] > before[i] ? levels[i] - before[i] : before[i] - levels[i];
      if (levels[i] > VB_TOP) most[2]++;
      if (step > most[0]) most[0] = step;
      if (resting && step > most[1]) most[1] = step;
      if (resting && levels[i] > before[i]) most[3]++;
      before[i] = levels[i];
    }
  }
  most[4] = vb.taken; most[5] = vb.trips;
}
"""


@cache
def library(folder: str, **macros: int) -> ctypes.CDLL:
    """The header as a library, for an array and rate."""
    source = Path(folder) / "harness.c"
    source.write_text(_HARNESS)
    target = Path(folder) / ("harness" + "".join(f"-{n}" for n in macros.values()) + ".so")
    given = {"VB_ROWS": 2, "VB_COLUMNS": 3, "VB_TOP": 255, "VB_FAST": 166, "VB_RATE": 1000}
    about = (
        r'-DVB_ABOUT="\"name\":\"H\",\"pitch_mm\":[1,1],\"rest\":\"left\",'
        r'\"counts_per_mm\":[200],\"travel_mm\":[100]"'
    )
    options = [f"-D{name}={value}" for name, value in (given | macros).items()]
    flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-DVB_ANALOG=0"]
    subprocess.run(
        ["cc", *flags, *options, about, f"-I{FIRMWARE}", str(source), "-o", str(target)], check=True
    )
    return ctypes.CDLL(str(target))


class Header:
    """One device made of the header, fresh."""

    def __init__(self, folder: Path, actuators: int = 6, **macros: int) -> None:
        # A library that is loaded twice has one memory: each device has a file of its own.
        self._library = library(str(folder), **macros)
        self._out = (ctypes.c_uint8 * 256)()
        self._levels = (ctypes.c_uint16 * actuators)()

    def hear(self, chunk: bytes) -> None:
        """Take bytes from the host."""
        self._library.hear(chunk, len(chunk))

    def tick(self, us: int, x: int = 0, *, room: bool = True) -> bytes:
        """Do a tick; give what it sends."""
        us &= 0xFFFFFFFF
        count = self._library.tick(ctypes.c_uint32(us), x, int(room), self._out, self._levels)
        return bytes(self._out[:count])

    def say(self, code: int) -> None:
        """Tell the host something."""
        self._library.say(code)

    @property
    def levels(self) -> list[int]:
        """Levels that the actuators were last driven to."""
        return list(self._levels)

    def soak(self, chunks: list[bytes], us: np.ndarray) -> list[int]:
        """Do ticks with these bytes before each; see the harness for what it gives."""
        counts = np.array([len(chunk) for chunk in chunks], np.int32)
        most = np.zeros(8, np.int32)
        pointer = ctypes.c_void_p
        self._library.soak(
            b"".join(chunks),
            pointer(counts.ctypes.data),
            pointer(us.ctypes.data),
            len(chunks),
            pointer(most.ctypes.data),
        )
        return most.tolist()
