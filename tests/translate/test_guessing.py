"""What language a text looks like is told where that is clear, and said once."""

import pytest

from vbraille.translate import Book, BrailleTable, Document
from vbraille.translate.languages import has_tables
from vbraille.translate.scripts import guess_language

DECLARATION = {
    "en": "All human beings are born free and equal in dignity and rights. They are endowed with "
    "reason and conscience and should act towards one another in a spirit of brotherhood.",
    "de": "Alle Menschen sind frei und gleich an Würde und Rechten geboren. Sie sind mit Vernunft "
    "und Gewissen begabt und sollen einander im Geist der Brüderlichkeit begegnen.",
    "fr": "Tous les êtres humains naissent libres et égaux en dignité et en droits. Ils sont doués "
    "de raison et de conscience et doivent agir les uns envers les autres dans un esprit.",
    "es": "Todos los seres humanos nacen libres e iguales en dignidad y derechos y, dotados como "
    "están de razón y conciencia, deben comportarse fraternalmente los unos con los otros.",
    "it": "Tutti gli esseri umani nascono liberi ed eguali in dignità e diritti. Essi sono dotati "
    "di ragione e di coscienza e devono agire gli uni verso gli altri in spirito di fratellanza.",
    "pl": "Wszyscy ludzie rodzą się wolni i równi pod względem swej godności i swych praw. Są oni "
    "obdarzeni rozumem i sumieniem i powinni postępować wobec innych w duchu braterstwa.",
    "nl": "Alle mensen worden vrij en gelijk in waardigheid en rechten geboren. Zij zijn begiftigd "
    "met verstand en geweten, en behoren zich jegens elkander in een geest van te gedragen.",
    "sv": "Alla människor är födda fria och lika i värde och rättigheter. De har utrustats med "
    "förnuft och samvete och bör handla gentemot varandra i en anda av gemenskap.",
    "hu": "Minden emberi lény szabadon születik és egyenlő méltósága és joga van. Az emberek, "
    "ésszel és lelkiismerettel bírván, egymással szemben testvéri szellemben kell hogy éljenek.",
    "el": "Ολοι οι ανθρωποι γεννιουνται ελευθεροι και ισοι στην αξιοπρεπεια και τα δικαιωματα.",
}


@pytest.mark.parametrize(("language", "text"), DECLARATION.items())
def test_plain_prose(language, text):
    assert guess_language(text)[0] == language
    assert has_tables(language)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "oui",
        "1 2 3 4 5 6 7 8 9 10 11 12",
        "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda",
        "apple, pear, plum, cherry, quince, orange, lemon, melon, grape, fig",
        "der die das und le la les des the of and to il la di che",
        "x = a + b; y = a - b; print(x, y, z); if x: return y",
    ],
)
def test_nothing_is_told_of_what_is_not_clear(text):
    assert guess_language(text) == ("", "")


def notes(text, **how):
    book = Book(Document.from_text(text), BrailleTable("en-ueb-g2.ctb"), **how)
    found = list(book.notes())
    assert book.block(0) is not None
    return found + list(book.notes())


def test_it_is_said_once_with_what_to_type():
    (note,) = notes(DECLARATION["de"], unnamed=True)
    assert note == (
        "this text looks like German, and is translated by the table en-ueb-g2.ctb; "
        "‹language› de has it translated as German"
    )
    (note,) = notes(DECLARATION["el"], unnamed=True)
    assert "looks like Greek" in note


def test_what_somebody_chose_needs_no_hint():
    assert notes(DECLARATION["de"]) == []
    assert notes(DECLARATION["en"], unnamed=True) == []
