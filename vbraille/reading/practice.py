"""Short texts of our own to practise on, as long as somebody needs them."""

from __future__ import annotations

_TEXTS = {
    "en": (
        "The night train stops at a small station where nobody gets on. A man with a lamp walks "
        "along the carriages, knocks at each wheel and listens. When the last one has rung, he "
        "lifts the lamp, and the train goes on towards the sea."
    ),
    "fr": (
        "Le train de nuit s'arrête dans une petite gare où personne ne monte. Un homme avec une "
        "lampe longe les voitures, frappe sur chaque roue et écoute. Quand la dernière a sonné, "
        "il lève la lampe, et le train repart vers la mer."
    ),
    "de": (
        "Der Nachtzug hält an einem kleinen Bahnhof, an dem niemand einsteigt. Ein Mann mit einer "
        "Lampe geht an den Wagen entlang, klopft an jedes Rad und horcht. Wenn das letzte "
        "geklungen hat, hebt er die Lampe, und der Zug fährt weiter zum Meer."
    ),
}
_TIMES = 100  # paragraphs; a reader who tries everything twice needs some twenty


def practice_text(language: str | None = None) -> str:
    """Text to practise on, again and again the same paragraph, in a language if there is one.

    Parameters
    ----------
    language
        Language, such as "fr" or "fr-CA"; English for None and where there is no such text.
    """
    known = _TEXTS.get((language or "en").split("-")[0].lower(), _TEXTS["en"])
    return "\n\n".join([known] * _TIMES)
