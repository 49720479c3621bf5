"""Sessions in this process, as fast as the machine can, with an experimenter of a few lines."""

import re
import time
from dataclasses import dataclass, field

from vbraille.sessions.running.answers import Line, NoMoreAnswers
from vbraille.sessions.session import Session

HEAD = 'name = "mini"\ntitle = "A few cells"\nmodel = "vbd"\n'
MINI = f'{HEAD}[design]\nkind = "list"\nstrings = ["ac", "ca", "aa"]\n'
SURE = "[question]\nkind = 'identify'\nconfidence = { least = 1, most = 4 }\n"
WIDTHS = f"""{HEAD}[design]
kind = "choice"
parameter = "dot_width_mm"
values = [1.0, 2.0]
string = "a"
"""


class Person:
    """Types each line when what was said last matches its pattern."""

    name = "typed"
    typed = True
    felt = False

    def __init__(self, said, script):
        self.said, self.script = said, list(script)
        self.seen, self.waited = len(said), 0

    def line(self, _asked, wait_s):
        if not self.script:
            raise NoMoreAnswers
        pattern, line = self.script[0]
        for number, sentence in enumerate(self.said[self.seen :], self.seen):
            if re.search(pattern, sentence):
                self.seen, self.waited = number + 1, 0
                self.script.pop(0)
                return Line(line)
        time.sleep(wait_s)
        self.waited += 1
        most = 1500 if wait_s else 300
        assert self.waited < most, f"{pattern!r} is never said: {self.said[-20:]}"
        return None


@dataclass
class Sat:
    """What came of a sitting."""

    session: Session
    said: list = field(default_factory=list)

    @property
    def events(self):
        return self.session.content.events

    def of(self, *kinds):
        return [event for event in self.events if event.kind in kinds]

    def sit(self, *script, **how):
        """Go on with the session; a script of lines is typed, if there is one."""
        how = {"fast": True, "hand": "sweep:150", **how}
        answers = how.pop("answers", None)
        if script:
            answers = Person(self.said, script)
            self.said.append("begin")
        self.session.run(answers, say=self.said.append, **how)
        return self


def made(folder, protocol=MINI, participant="P01", **how):
    """A session of a protocol, which has not begun."""
    path = folder / f"{participant}.toml"
    path.write_text(protocol, "utf-8")
    session = Session.create(path, participant, path=folder / f"{participant}.session",
                             **{"seed": 1, **how})  # fmt: skip
    return Sat(session)
