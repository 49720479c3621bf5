"""What the participants of the samples did, from our own tables, for the programs to write down."""

from __future__ import annotations

import csv
from pathlib import Path

HERE = Path(__file__).parent.parent
KEYS = {"yes": "y", "no": "n", "same": "s", "different": "d"}
TEXTURES = {"smooth": "0", "rough": "100"}
PRACTICE = [("ab", 4.1), ("cd", 3.2)]


def letters() -> dict[str, list[dict[str, str]]]:
    """Strings that were read, by participant: string, texture, answer and rt in seconds."""
    found: dict[str, list[dict[str, str]]] = {}
    for row in _rows("trials.csv"):
        found.setdefault(row["participant"], []).append(
            {
                "string": row["presented"],
                "texture": TEXTURES[row["condition"]],
                "answer": row["answered"],
                "rt": row["duration_s"],
            }
        )
    return found


def questions() -> dict[str, list[dict[str, str]]]:
    """Questions that were answered, by participant, as an experiment of another lab has them."""
    found: dict[str, list[dict[str, str]]] = {}
    for row in _rows("questions.csv"):
        kind, shown, answer = row["question"], row["presented"], row["answered"]
        first, second = shown.split() if kind == "which" else ("", "")
        if kind == "which":
            answer = "f" if answer == first else "j"
        found.setdefault(row["participant"], []).append(
            {
                "task": kind,
                "shown": {"yes": "present", "no": "absent"}.get(shown, "" if first else shown),
                "first": first,
                "second": second,
                "texture": row["texture"],
                "answer": KEYS.get(answer, answer),
                "right": {"": "", "right": "1", "hit": "1", "correct rejection": "1"}.get(
                    row["outcome"], "0"
                ),
                "sure": row["confidence"],
            }
        )
    return found


def _rows(name: str) -> list[dict[str, str]]:
    with (HERE / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(file))
