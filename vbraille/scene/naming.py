"""Places in scenes, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vbraille.scene.walking import Steps


def said(steps: Steps) -> str:
    """Words for a place in a scene, which keys and indices lead to.

    >>> said(("elements", 3, "fill", "texture"))
    'elements, number 4 fill texture'
    """
    words = (f", number {step + 1}" if isinstance(step, int) else f" {step}" for step in steps)
    return "".join(words).strip()


def about(steps: Steps, problem: str) -> str:
    """Sentence about a place in a scene; the problem begins with a colon or a verb.

    >>> about(("elements", 0), "has no place")
    'elements, number 1 has no place'
    """
    return f"{said(steps)}{problem}" if problem.startswith(":") else f"{said(steps)} {problem}"
