"""The plan of a session: all that will be shown, in its order, before the first trial."""

from __future__ import annotations

from msgspec import Struct, field

from vbraille.sessions.planning import planfile
from vbraille.sessions.planning.stimuli import Stimulus, Trial, check_participant, check_seed


class Plan(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """All trials of a session, in order. Its file has its fields in this order.

    Parameters
    ----------
    version
        Of how it was made: 1 drew practice from the test, and did not draw by the protocol's
        name. Nothing makes such plans any more; those of sessions are kept.
    protocol
        Its name.
    participant
        A pseudonym.
    seed
        Of all that is drawn.
    order
        Which of the balanced orders of conditions, from 1; 0 if there is only one.
    practice, trials
        In the order in which they are shown.

    Raises
    ------
    ValueError
        If the participant, the seed or the order cannot be used.
    """

    version: int = field(name="format", default=planfile.VERSIONS[-1])
    protocol: str
    participant: str
    seed: int
    order: int
    practice: tuple[Trial, ...]
    trials: tuple[Trial, ...]

    def __post_init__(self) -> None:
        check_participant(self.participant)
        check_seed(self.seed)
        if self.order < 0:
            raise ValueError(f"order is {self.order}; it must be 0 or more")
        if self.version not in planfile.VERSIONS:
            raise ValueError(f"version is {self.version}; it must be 1 or 2")

    def stimuli(self) -> list[Stimulus]:
        """All stimuli of all trials, practice among them."""
        return [stimulus for trial in (*self.practice, *self.trials) for stimulus in trial.stimuli]

    def to_json(self) -> str:
        """JSON, a trial a line; the same bytes on every machine."""
        head = {"format": self.version}
        head |= {n: getattr(self, n) for n in ("protocol", "participant", "seed", "order")}
        return planfile.encode(head, {"practice": self.practice, "trials": self.trials})

    @classmethod
    def from_json(cls, text: str) -> Plan:
        """Read the plan that `to_json` wrote.

        Raises
        ------
        InputError
            If it is damaged.
        """
        return planfile.decode(text, cls)
