"""Commands that an experimenter may type beside answers; each is an entry of `COMMANDS`."""

from __future__ import annotations

from vbraille.sessions.running.runner import Again, Command, Over, Runner


def _answer(runner: Runner, text: str) -> None:
    """Do nothing: the text is an answer."""


def _undo(runner: Runner, _: str) -> None:
    newest = runner.progress.newest_given
    if newest is None:
        runner.say("undo: there is no answer to take back")
        return
    if newest.kind == "reply":
        runner.trial = None
        runner.log("undo", name=newest.data["name"], number=newest.data["number"])
        raise Again
    runner.withdraw()
    trial = next(each for each in runner.progress.plan.trials if each.key == newest.key)
    runner.trial, runner.attempt = trial, runner.progress.attempts(trial)
    runner.log("undo")
    raise Again


def _repeat(runner: Runner, _: str) -> None:
    if not runner.is_shown:
        runner.say("repeat: no trial is open")
        return
    runner.log("repeat")
    raise Again


def _note(runner: Runner, text: str) -> None:
    if not text:
        runner.say("note: type the note after the word")
        return
    runner.log("note", text=text)
    runner.say("note: is in")


def _pause(runner: Runner, _: str) -> None:
    if runner.paused:
        runner.go()
    else:
        runner.pause()


def _go(runner: Runner, _: str) -> None:
    if runner.paused:
        runner.go()
    else:
        runner.say("go: nothing is paused; if it is the answer, type answer go")


def _break(runner: Runner, _: str) -> None:
    runner.break_wanted = True
    if runner.trial is None or runner.is_shown or runner.progress.lacks_confidence(runner.trial):
        runner.say("break: after this trial")
    else:
        raise Again


def _begin(runner: Runner, _: str) -> None:
    if runner.progress.practice_is_over:
        runner.say("begin: practice is over already")
        return
    runner.withdraw()
    runner.trial = None
    runner.log("begin")
    raise Again


def _stop(_runner: Runner, _: str) -> None:
    raise Over("stop", "stopped by the experimenter")


def _quit(runner: Runner, reason: str) -> None:
    if not reason:
        runner.say("quit: type the reason after the word; stop ends for now alone")
        return
    raise Over("end", "the participant stopped", reason=reason)


def _help(runner: Runner, _: str) -> None:
    asks = runner.protocol.asks
    if runner.asked is not None and runner.asked.item is not None:
        runner.say(f"question: {runner.asked.item.ask} Type {runner.asked.item.typed}")
    elif asks.ask:
        runner.say(f"question: {asks.ask}")
    runner.say(f"an answer: {asks.typed}")
    if asks.confidence is not None:
        least, most = asks.confidence.least, asks.confidence.most
        runner.say(f"confidence: {least} to {most}, after the answer or after a semicolon")
    runner.say("Enter: go on after a pause or a break")
    for word, command in runner.commands.items():
        runner.say(f"{word}: {command.help}")


COMMANDS: dict[str, Command] = {
    "answer": Command(_answer, "before an answer that is also a command", takes=True),
    "command": Command(_answer, "before a command that is also a string", takes=True),
    "undo": Command(_undo, "take back the last answer, and type it again"),
    "repeat": Command(_repeat, "show the open trial again, from its start"),
    "note": Command(_note, "write the rest of the line into the record", takes=True),
    "pause": Command(_pause, "bring the array to rest; Enter goes on"),
    "go": Command(_go, "go on after a pause"),
    "break": Command(_break, "have a break after the open trial"),
    "begin": Command(_begin, "end practice"),
    "stop": Command(_stop, "stop for now; session resume goes on"),
    "quit": Command(_quit, "end for good; the participant's reason after it", takes=True),
    "help": Command(_help, "list what may be typed"),
}
