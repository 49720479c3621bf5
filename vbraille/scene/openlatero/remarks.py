"""What is said about a file: what was ignored, changed, or is shown differently here."""

from __future__ import annotations

from dataclasses import dataclass, field

_MOST_LINES = 5  # that one remark names, when it holds for many places


@dataclass(slots=True)
class Remarks:
    """Remarks on places of a file, as they come."""

    _lines: dict[tuple[str, str], list[int]] = field(default_factory=dict)

    def add(self, line: int, element: str, text: str) -> None:
        """Say something about an element.

        Parameters
        ----------
        line
            Line at which it begins, from 1.
        element
            What it is, such as "Circle".
        text
            The rest of the sentence.
        """
        self._lines.setdefault((element, text), []).append(line)

    def listed(self) -> tuple[str, ...]:
        """All remarks, in the order of their first lines; what holds at many places is said once.

        >>> remarks = Remarks()
        >>> for line in (9, 4):
        ...     remarks.add(line, "Circle", "its icon is ignored")
        >>> remarks.listed()
        ('line 4, Circle: its icon is ignored (and line 9)',)
        """
        found = sorted((sorted(set(lines)), *key) for key, lines in self._lines.items())
        return tuple(
            f"line {lines[0]}, {element}: {text}{_others(lines[1:])}"
            for lines, element, text in found
        )


def _others(lines: list[int]) -> str:
    """Other lines for which a remark holds."""
    if not lines:
        return ""
    named = ", ".join(map(str, lines[:_MOST_LINES]))
    more = len(lines) - _MOST_LINES
    rest = f" and {more} more" if more > 0 else ""
    return f" (and line{'s' if len(lines) > 1 else ''} {named}{rest})"
