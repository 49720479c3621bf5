"""Markers for other recorders: what they are told, how late, and one that is gone."""

import csv
import os
import sys
import tty
from queue import Queue
from threading import Event

import pytest

from tests.sessions.sittings import MINI, Session
from tests.sessions.written import LETTERS
from vbraille.devices import open_device
from vbraille.engine.batch import BatchEngine
from vbraille.errors import InputError
from vbraille.sessions import session as door
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record import events
from vbraille.sessions.running.markers import Markers, MarkerSpec, parse_markers

FAKE = """
sent, streams = [], []
def local_clock():
    return 1000.0
class StreamInfo:
    def __init__(self, *told):
        streams.append(told)
class StreamOutlet:
    def __init__(self, info):
        assert isinstance(info, StreamInfo)
    def push_sample(self, sample, timestamp):
        sent.append((sample, timestamp))
"""


@pytest.fixture
def packages(tmp_path, monkeypatch):
    """A directory that modules come from; pylsl is not loaded from elsewhere."""
    kept = {name: sys.modules.pop(name) for name in [*sys.modules] if name.startswith("pylsl")}
    (tmp_path / "packages").mkdir()
    monkeypatch.syspath_prepend(tmp_path / "packages")
    yield tmp_path / "packages"
    sys.modules.pop("pylsl", None)
    sys.modules.update(kept)


@pytest.fixture
def port():
    """A serial port, as a pseudo-terminal; its other end."""
    master, slave = os.openpty()
    tty.setraw(slave)
    ends = {"master": master, "slave": slave}
    yield ends, os.ttyname(slave)
    for end in ends.values():
        os.close(end)


def sit(folder, markers, toml=MINI):
    """A whole session with markers; its events, what was said, and the rows of its list."""
    Session(folder, toml)
    session = door.Session.resume(
        folder,
        fast=True,
        markers=markers,
        engine=lambda spec, wanted: BatchEngine(open_device(spec, wanted), poll_ticks=100),
    )
    said = []
    session.run("simulated", say=said.append)
    told = session.record.journal.events[1:]  # the first is older than the run
    with (folder / "markers-001.csv").open() as file:
        return told, [line for line in said if line.startswith("markers")], [*csv.DictReader(file)]


class Taking:
    """Is a spec and its port: takes markers, unless it is told to fail or to wait."""

    def __init__(self):
        self.taken, self.opened, self.broken = Queue(), 0, False
        self.waits = None

    def open(self):
        self.opened += 1
        return self

    def send(self, marker):
        if self.waits is not None:
            self.waits.wait(30)
        if self.broken:
            raise OSError(5, "Input/output error")
        self.taken.put(marker)

    def close(self):
        pass

    def __str__(self):
        return "recorder"


def cue(n):
    return events.Cue(n=n, t_s=0.0, trial=n)


def code_of(event):
    """Byte of an event: of what is presented that of the only condition."""
    return 101 if event.kind == "presented" else event.code


def test_a_marker_has_the_code_of_its_condition(tmp_path, port):
    _, name = port
    coded = LETTERS.replace("[practice]", "[markers]\ncodes = { smooth = 200 }\n[practice]")
    told, _, listed = sit(tmp_path / "s", f"serial:{name}", coded)
    shown = {int(row["n"]): row for row in listed if row["event"] == "presented"}
    of = {event.n: event for event in told if event.kind == "presented"}
    codes = {(row["condition"], row["byte"]) for row in shown.values()}
    assert codes == {("smooth", "200"), ("rough", "102")}
    assert {n: event.trial for n, event in of.items()} == {
        n: int(row["trial"]) for n, row in shown.items()
    }


@pytest.mark.parametrize(
    ("codes", "says"),
    [
        ("{ smoth = 60 }", "codes have 'smoth'; the nearest is smooth"),
        ("{ smooth = 7 }", "it must be 40 to 254"),
        ("{ smooth = 60, rough = 60 }", "codes have one twice"),
        ("{ smooth = 102 }", "codes give two conditions the same"),
    ],
)
def test_codes_that_cannot_be_are_refused(codes, says):
    with pytest.raises(InputError) as refused:
        parse_protocol(LETTERS + f"[markers]\ncodes = {codes}\n", "page.toml")
    assert says in str(refused.value)


def test_each_event_of_a_session_is_a_byte_at_a_serial_port(tmp_path, port):
    ends, name = port
    told, said, listed = sit(tmp_path / "s", f"serial:{name}")
    wanted, come = bytes(map(code_of, told)), b""
    while len(come) < len(wanted):  # a terminal hands on what it has, not all that was sent
        come += os.read(ends["master"], 4096)
    assert come == wanted
    assert [(int(row["n"]), row["event"], int(row["byte"])) for row in listed] == [
        (event.n, event.kind, code_of(event)) for event in told
    ]
    cues = [row for row in listed if row["event"] == "cue"]
    assert [row["trial"] for row in cues] == ["1", "2", "3", "4"]
    assert all(float(row["late_ms"]) >= 0 for row in listed)
    assert {row["recorder"] for row in listed} == {f"serial:{name}"}
    assert len(said) == 1
    assert said[0].startswith(f"markers: {len(told)} sent to serial:{name}, late by ")


def test_each_event_is_a_text_of_a_stream(tmp_path, packages):
    (packages / "pylsl").mkdir()
    (packages / "pylsl" / "__init__.py").write_text(FAKE)
    told, said, listed = sit(tmp_path / "s", "lsl:reading")
    import pylsl

    assert pylsl.streams == [("reading", "Markers", 1, 0, "string", "vbraille-reading")]
    texts = [sample[0] for sample, _ in pylsl.sent]
    assert texts[0] == "run"
    assert "cue trial 4" in texts
    assert texts[-1] == "closed"
    assert len(texts) == len(told) == len(listed)
    # The time of each is that of the event, and not that of the sending.
    for (_, at_s), row in zip(pylsl.sent, listed, strict=True):
        assert 1000 - at_s <= float(row["late_ms"]) / 1000 + 1e-6
        assert at_s <= 1000
    assert said[0].startswith(f"markers: {len(told)} sent to lsl:reading, late by")


def test_a_stream_of_the_real_layer(tmp_path):
    pylsl = pytest.importorskip("pylsl")
    spec = parse_markers("lsl:vbraille-test")
    markers = Markers(spec)
    markers.begin(tmp_path)
    (found,) = pylsl.resolve_byprop("name", "vbraille-test", timeout=10)
    inlet = pylsl.StreamInlet(found)
    inlet.open_stream(timeout=10)
    markers.mark(cue(1), 0)
    sample, at_s = inlet.pull_sample(timeout=10)
    assert sample == ["cue trial 1"]
    assert abs(at_s - pylsl.local_clock()) < 10
    assert markers.close()[0].startswith("markers: 1 sent to lsl:vbraille-test")


def test_without_the_layer_a_sentence_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pylsl", None)
    with pytest.raises(InputError, match=r"need pylsl, which is not installed: pip install pylsl"):
        Markers(parse_markers("lsl"))


def test_a_layer_that_does_not_work_is_told(packages):
    (packages / "pylsl.py").write_text("raise RuntimeError('LSL binary library not found\\nmore')")
    with pytest.raises(InputError, match=r"does not work here: LSL binary library not found$"):
        Markers(parse_markers("lsl"))


def test_a_port_that_is_unplugged_ends_no_session(tmp_path, port):
    ends, name = port
    markers = Markers(parse_markers(f"serial:{name}"))
    for end in ("master", "slave"):
        os.close(ends.pop(end))
    markers.begin(tmp_path)
    for n in range(1, 4):
        markers.mark(cue(n), 0)
    assert markers.close() == [
        f"markers: 0 sent to serial:{name}",
        f"markers: 3 markers lost, since serial:{name} took none then",
    ]
    assert (tmp_path / "markers-001.csv").read_text().splitlines() == [
        "n,event,trial,practice,condition,byte,late_ms,recorder",
        *(f"{n},cue,{n},0,,3,,serial:{name}" for n in range(1, 4)),
    ]


def test_a_recorder_that_comes_back_is_sent_to_again(tmp_path):
    recorder, now = Taking(), [0]
    markers = Markers(recorder, now_ns=lambda: now[0])
    markers.begin(tmp_path)
    markers.mark(cue(1), 0)
    assert recorder.taken.get(timeout=30).n == 1
    recorder.broken = True
    markers.mark(cue(2), 0)
    while recorder.broken and markers._port is not None:
        os.sched_yield()
    recorder.broken = False
    markers.mark(cue(3), 0)  # a moment later: it is not looked for yet
    while not markers._queue.empty():
        os.sched_yield()
    now[0] += 2_000_000_000
    markers.mark(cue(4), 0)
    assert recorder.taken.get(timeout=30).n == 4
    assert markers.close()[1] == "markers: 2 markers lost, since recorder took none then"
    assert recorder.opened == 2


def test_a_recorder_that_hangs_holds_up_nothing(tmp_path):
    recorder = Taking()
    recorder.waits = Event()
    markers = Markers(recorder, room=5)
    markers.begin(tmp_path)
    for n in range(1, 101):
        markers.mark(cue(n), 0)  # returns at once, though nothing is taken
    recorder.waits.set()
    told = markers.close()
    assert recorder.taken.qsize() <= 7
    lost = 100 - recorder.taken.qsize()
    assert told[1] == f"markers: {lost} markers lost, since recorder took none then"


def test_lateness_is_from_the_event_to_the_marker_sent(tmp_path):
    now = [10_000_000]
    markers = Markers(Taking(), now_ns=lambda: now[0])
    markers.begin(tmp_path)
    who = {"n": 1, "t_s": 0.0, "trial": 2, "practice": True}
    contact = events.Contact(**who, attempt=1, stimulus=0, time_ns=1, tick=1)
    markers.mark(contact, 4_500_000)
    assert markers.close() == ["markers: 1 sent to recorder, late by 4.5 ms, at most 4.5 ms"]
    assert (tmp_path / "markers-001.csv").read_text().splitlines()[
        1
    ] == "1,contact,2,1,,4,4.500,recorder"


def test_a_list_that_cannot_be_written_keeps_no_marker_back(tmp_path):
    recorder = Taking()
    markers = Markers(recorder)
    markers.begin(tmp_path / "nowhere")
    markers.mark(cue(1), 0)
    assert markers.close()[0].startswith("markers: 1 sent")


def test_a_list_gets_a_name_of_its_own_though_one_before_was_taken_away(tmp_path):
    (tmp_path / "markers-002.csv").write_text("kept")
    (tmp_path / "markers-x.csv").write_text("somebody's")
    markers = Markers(Taking())
    markers.begin(tmp_path)
    markers.close()
    assert (tmp_path / "markers-003.csv").read_text().startswith("n,event")
    assert (tmp_path / "markers-002.csv").read_text() == "kept"


# A session is there before its first run.
KINDS = sorted((kind for kind in events.KINDS[1:]), key=lambda kind: kind.code)


def test_every_byte_is_of_one_kind():
    assert [kind.code for kind in KINDS] == [*range(1, len(KINDS) + 1)]


def test_what_is_named_is_a_stream_or_a_port():
    assert parse_markers("lsl") == MarkerSpec("lsl", "vbraille")
    assert parse_markers("lsl:eeg") == MarkerSpec("lsl", "eeg")
    assert parse_markers("serial:/dev/ttyS0") == MarkerSpec("serial", "/dev/ttyS0", 115_200)
    assert parse_markers("serial:COM3:9600") == MarkerSpec("serial", "COM3", 9600)
    assert parse_markers("serial:/dev/ttyS0:0").baud == 115_200  # 0 bits a second is no rate
    for wrong in ("", "serial", "serial:", "usb:1", "LSL2"):
        with pytest.raises(InputError, match=r"markers.* is .*; give lsl, lsl:NAME, serial:PORT"):
            parse_markers(wrong)


def test_a_port_that_is_not_there_is_told_before_anything_begins(tmp_path):
    with pytest.raises(InputError, match="markers cannot be sent to /dev/none: No such file"):
        sit(tmp_path / "s", "serial:/dev/none")
    assert not (tmp_path / "s" / "markers-001.csv").exists()
