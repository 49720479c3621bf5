"""Results by hand: names that no page may take for its own, and all that a table can have."""

from tests.analysis.making import table_of
from tests.pictures.charts import bars, matrix, runs
from vbraille.analysis.results import (
    NOTE_COLUMN,
    Chapter,
    Column,
    Kind,
    ReportFigure,
    Results,
    ShownTable,
)

SCRIPT = "<script>alert('1')</script>"
NASTY = (
    f"S1 {SCRIPT}",
    'S"2" & \'co\' onerror="x"',
    "S3\udc80\0|`*_[a](http://evil.example)",
    "S4\n\n# 1. ~~x~~ $y$ \\ ]]> &amp; www.evil.example",
)

LEGIBILITY = table_of(
    told=(
        "legibility",
        "Legibility, by participant & condition",
        "Legibility is the share of strings that are right, <as in 3.4>.",
    ),
    columns=(
        Column("participant", "participant", "pseudonym"),
        Column("condition", "condition", "as in the protocol"),
        Column("trials", "trials", "answered", Kind.COUNT),
        Column("legibility", "legibility (%)", "right by answered", Kind.PERCENT),
        Column("duration_s", "mean duration (s)", "their mean", Kind.TENTHS),
        Column("p", "p", "of a test", Kind.P),
        NOTE_COLUMN,
    ),
    rows=tuple(
        row
        for number, name in enumerate(NASTY)
        for row in (
            (name, "nominal", 80, 0.8625, 4.75 + number, 0.0004, ""),
            (name, "textured", 0, None, None, None, f"no trials of {name}"),
        )
    ),
    notes=("The order of conditions: all began with nominal.", f"Why {SCRIPT}?"),
)
CONFUSIONS = table_of(
    told=("confusions", "Confusions of letters", ""),
    columns=(
        Column("presented", "presented", "letter presented"),
        *(Column(f"answered_{letter}", letter, "answered so", Kind.COUNT) for letter in "abc"),
    ),
    rows=(("a", 30, 5, 0), ("b", 10, 28, 4)),
    marks=(4, 9),
)
TRIALS = table_of(
    told=("trials", "All trials", ""),
    columns=(
        Column("trial", "trial", "number", Kind.COUNT),
        Column("strain", "strain", "", Kind.NUMBER),
    ),
    rows=tuple((number, number / 3) for number in range(1, 151)),
)
NOTHING = table_of(
    (Column("a", "a", ""),),
    (),
    ("No traces were given.",),
    told=("patterns", "Reading patterns", ""),
)

RESULTS = Results(
    f"Legibility of {SCRIPT}",
    (("Data", "2 sessions of “a & b”"), ("versions", "vbraille 0.1"), ("left out", NASTY[2])),
    ("The device was simulated.", SCRIPT),
    (
        Chapter(
            "Legibility",
            (LEGIBILITY, CONFUSIONS),
            (
                ReportFigure(
                    "legibility",
                    "Legibility",
                    f"S1 reads best. {SCRIPT}",
                    "legibility",
                    bars(NASTY),
                ),
                ReportFigure(
                    "confusions", "Confusions", "a is taken for b.", "confusions", matrix()
                ),
            ),
        ),
        Chapter(
            "Over <time>",
            (TRIALS, NOTHING),
            (ReportFigure("runs", "Over time", "It falls.", "trials", runs()),),
        ),
    ),
    question=("Planned: legibility.", f"Not ended: {NASTY[1]}."),
    findings=("Participants read right 86.3 % of strings.", f"The least was {NASTY[0]}."),
    shown=ShownTable(
        ("what", "people", "legibility (95 % interval)", "corrected p"),
        ((NASTY[0], "4", "86.3 % (80 % to 90 %)", ""), ("é", "4", "80 %", "< 0.001")),
    ),
    notes=(f"no interval: {NASTY[2]}",),
    main="legibility",
    methods=f"4 participants read. {SCRIPT}",
    excluded=(f"participant {NASTY[3]}: slept",),
)
BARE = Results("Nothing", (), (), (Chapter("Patterns", (NOTHING,)),))
