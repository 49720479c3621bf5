"""What the simulated reader predicts for a published experiment, and for less contrast.

Reported, whatever it is: the reader's model was stated before it was asked, and nothing of it
follows from these numbers.
"""

from __future__ import annotations

import csv
import io
import re
import statistics
import subprocess
import tempfile
from bisect import bisect_left
from pathlib import Path
from typing import TYPE_CHECKING

from tests.benchmarks.timing import Result, vbraille
from vbraille.sessions.planning.loading import FOLDER

if TYPE_CHECKING:
    from collections.abc import Iterator

# Share of the letters that were identified (Lévesque 2009, 4.3), by condition.
PUBLISHED = {"T0": 0.50, "T25": 0.56, "T100": 0.64}
NOISES = [n / 50 for n in range(1, 61)]  # 0.02 to 1.2
PARTICIPANTS = 6
NOISE = 0.15
CONTRASTS = (1.0, 0.8, 0.6, 0.4, 0.2)


def run() -> Iterator[Result]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        yield _textures(folder)
        for condition in ("T100", "T0"):
            yield _contrasts(folder, condition)


def _textures(folder: Path) -> Result:
    plain = _only(folder, "T0")
    noise = _search(folder, plain)
    all_shares = [
        legibility(folder, "letters", number, noise) for number in range(1, PARTICIPANTS + 1)
    ]
    means = {name: statistics.mean(shares[name] for shares in all_shares) for name in PUBLISHED}
    order = _order(means)
    agrees = order == _order(PUBLISHED)
    same = sum(_order(shares) == _order(PUBLISHED) for shares in all_shares)
    spread = statistics.stdev(shares["T100"] - shares["T0"] for shares in all_shares)
    published = ", ".join(f"{share:.0%}" for share in PUBLISHED.values())
    verdict = "agrees" if agrees else f"is {' < '.join(order)}, which does not agree"
    gain = means["T100"] - means["T0"]
    return Result(
        f"letters identified by the simulated reader with texture 0, 25, 100 % "
        f"(published {published}), {PARTICIPANTS} participants, noise {noise:g} so that the first "
        f"identifies about half without texture",
        "reported",
        f"{', '.join(f'{means[name]:.1%}' for name in PUBLISHED)}; the order {verdict}, in {same} "
        f"of {PARTICIPANTS} it agrees (full texture beyond none {gain:+.1%}, s.d. {spread:.1%})",
        met=True,
    )


def _order(shares: dict[str, float]) -> list[str]:
    """Conditions, the least legible first."""
    return sorted(shares, key=shares.__getitem__)


def _search(folder: Path, protocol: str) -> float:
    """Noise of the list with which the first participant identifies nearest to half at T0."""
    shares = {}

    def share(noise: float) -> float:
        if noise not in shares:
            shares[noise] = legibility(folder, protocol, 1, noise)["T0"]
        return shares[noise]

    bisect_left(NOISES, -0.5, key=lambda noise: -share(noise))
    return min(shares, key=lambda noise: abs(shares[noise] - 0.5))


def _contrasts(folder: Path, condition: str) -> Result:
    shares = [
        legibility(folder, _only(folder, condition, contrast), 1, NOISE)[condition]
        for contrast in CONTRASTS
    ]
    return Result(
        f"letters identified by the simulated reader with texture {condition[1:]} % and contrast "
        f"{', '.join(f'{contrast:g}' for contrast in CONTRASTS)}, noise {NOISE:g}",
        "reported",
        ", ".join(f"{share:.1%}" for share in shares),
        met=True,
    )


def _only(folder: Path, condition: str, contrast: float = 1.0) -> str:
    """A protocol of the letters in one condition alone."""
    path = folder / f"{condition}-{contrast:g}.toml"
    conditions = re.compile(r'\[\[conditions\]\]\nname = "(\w+)"\n.*\n\n')
    text = (FOLDER / "letters.toml").read_text("utf-8")
    text = conditions.sub(lambda m: m[0] if m[1] == condition else "", text)
    path.write_text(text.replace("[display]\n", f"[display]\ncontrast = {contrast:g}\n"))
    return str(path)


def legibility(folder: Path, protocol: str, participant: int, noise: float) -> dict[str, float]:
    """Share of the letters that a simulated reader identifies, each in its place, by condition."""
    with tempfile.TemporaryDirectory(dir=folder) as name:
        session = str(Path(name) / "one.session")
        who = ["--participant", f"P{participant:02}", "--seed", str(participant)]
        how = ["--answers", f"simulated:{noise:g}", "--hand", "slow", "--fast"]
        command = vbraille("session", "run", protocol, *who, *how, "--out", session)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        export = vbraille("session", "export", session)
        table = subprocess.run(export, check=True, stdout=subprocess.PIPE, text=True).stdout
    right: dict[str, list[bool]] = {}
    for row in csv.DictReader(io.StringIO(table)):
        letters = zip(row["presented"], row["answered"], strict=True)
        right.setdefault(row["condition"], []).extend(one == other for one, other in letters)
    return {name: statistics.mean(letters) for name, letters in right.items()}
