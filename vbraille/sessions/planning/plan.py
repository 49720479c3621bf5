"""The plan of a session: all that will be shown, in order, fixed before the first trial."""

from __future__ import annotations

from msgspec import Struct, field

from vbraille.sessions.planning import planfile
from vbraille.sessions.planning.stimuli import Stimulus, Trial, check_participant, check_seed


class Plan(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """All trials of a session, in order. The plan's file has the fields in the order given here.

    Parameters
    ----------
    version
        Version of the rules that the plan was made by.
    protocol
        Name of the protocol.
    participant
        Pseudonym of the participant.
    seed
        Number that all random choices followed from.
    order
        Number of the balanced order of conditions, or the row of the table of orders, from 1; 0 if
        there is only one order.
    group
        Name of the participant's group; empty if there are no groups.
    practice, trials
        Practice trials and trials of the test, each in the order in which they are shown.

    Raises
    ------
    ValueError
        If the participant, the seed or the order cannot be used.
    """

    version: int = field(name="format", default=planfile.VERSION)
    protocol: str
    participant: str
    seed: int
    order: int
    group: str = ""
    practice: tuple[Trial, ...]
    trials: tuple[Trial, ...]

    def __post_init__(self) -> None:
        check_participant(self.participant)
        check_seed(self.seed)
        if self.order < 0:
            raise ValueError(f"order is {self.order}; it must be 0 or more")

    def stimuli(self) -> list[Stimulus]:
        """All stimuli of all trials, practice included."""
        return [stimulus for trial in (*self.practice, *self.trials) for stimulus in trial.stimuli]

    def to_json(self) -> str:
        """Plan as JSON with one trial on each line; the bytes are the same on every machine."""
        head: dict[str, str | int] = {"format": self.version}
        head |= {n: getattr(self, n) for n in ("protocol", "participant", "seed", "order")}
        if self.group:
            head["group"] = self.group
        return planfile.encode(head, {"practice": self.practice, "trials": self.trials})

    @classmethod
    def from_json(cls, text: str) -> Plan:
        """Read a plan that `to_json` wrote.

        Raises
        ------
        InputError
            If the text is damaged, or the plan is of another version.
        """
        return planfile.decode(text, cls)
