"""Pictures as stimuli: planned, felt on a surface, named by key with confirmation, and remade."""

from pathlib import Path

import numpy as np
import pytest

from tests.sessions.bidsvalid import complaints
from tests.sessions.sittings import Person, crash, of
from vbraille.devices import open_device
from vbraille.engine.batch import BatchEngine
from vbraille.errors import InputError
from vbraille.render import Tuning
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.planning.protocolfiles import load_protocol
from vbraille.sessions.record import bids
from vbraille.sessions.record.folder import check_folder, load
from vbraille.sessions.record.replay import frames
from vbraille.sessions.session import Session, room_for

SCENE = """
[canvas]
width_mm = 40
height_mm = 30
[[elements]]
kind = "circle"
id = "circle"
center_mm = [20, 15]
radius_mm = 10
stroke = {width_mm = 1.5, vibration = {frequency_hz = 50}}
[[elements]]
kind = "polygon"
id = "square"
vertices_mm = [[10, 5], [30, 5], [30, 25], [10, 25]]
fill = {texture = {kind = "linear-grating", ridge_mm = 2.0, ridge_angle_deg = 90}, fade_mm = 0}
"""
TOML = """
format = 1
name = "two"
title = "Two pictures"
source = "ours"
model = "pantograph"
[display]
scene = "two.scene"
[design]
kind = "list"
strings = ["circle", "square"]
repeats = 2
[question]
kind = "name"
choices = [{names = {c = "circle", s = "square"}}]
[practice]
trials = 2
[trial]
exposure_s = 5
"""
FAST = Conditions(hand="wide", fast=True)


def written(folder: Path, toml: str = TOML, scene: str = SCENE) -> str:
    folder.mkdir(exist_ok=True)
    (folder / "two.scene").write_text(scene)
    (folder / "two.toml").write_text(toml)
    return str(folder / "two.toml")


def begun(folder: Path, toml: str = TOML) -> Session:
    protocol = written(folder, toml)
    return Session.create(protocol, "P1", folder=folder / "s", seed=1, conditions=FAST)


def refused(folder: Path, toml: str = TOML, scene: str = SCENE) -> str:
    with pytest.raises(InputError) as refusal:
        load_protocol(written(folder, toml, scene))
    return str(refusal.value)


def test_a_simulated_person_names_what_it_felt_and_every_frame_is_made_again(tmp_path):
    session = begun(tmp_path)
    session.run("simulated:0")
    rows = session.trials
    assert [row["answered"] for row in rows] == [row["presented"] for row in rows]
    assert {row["correct"] for row in rows} == {1}
    assert {row["scene"] for row in rows} == {"two.scene"}
    assert {row["dot_width_mm"] for row in rows} == {""}
    assert all(finding.good for finding in check_folder(session.folder, None))
    strong = {}
    for line, ticks, deflections in frames(session.record):
        if line:
            assert np.isfinite(deflections).all()
            assert np.ptp(ticks["y_mm"]) > 20  # the hand goes over the whole picture
            strong[line] = deflections.max()
    assert sorted(strong) == [1, 2, 3, 4]
    assert min(strong.values()) > 0.9


def test_frames_sent_are_the_frames_replayed_bit_for_bit(tmp_path):
    sent = {}

    class Heard:
        name, typed, felt = "program", False, True

        def lines(self, _wait_s):
            return []

        def next(self, trial, _attempt, felt):
            sent[trial.number] = felt[-1].frames
            return trial.presented, 0

        def reply(self, *_):
            return None

    session = begun(tmp_path)
    session.run(Heard())
    remade = {line: deflections for line, _, deflections in frames(session.record)}
    for line, deflections in sent.items():
        assert len(deflections) > 1000
        whole = remade[line].astype(np.float32)
        starts = [
            n for n in range(3) if np.array_equal(whole[n : n + len(deflections)], deflections)
        ]
        assert starts


def test_killed_and_resumed_nothing_is_lost(tmp_path):
    session = begun(tmp_path)
    session.run("simulated:0.3")
    whole = [row["answered"] for row in session.trials]
    journal = session.folder / "journal.jsonl"
    size = len(journal.read_bytes())
    for part in (0.8, 0.5, 0.2):
        kept = [e for e in session.record.journal.events if e.kind == "answer"]
        crash(session.folder, int(size * part))
        again = Session.resume(session.folder, fast=True)
        again.run("simulated:0.3")
        assert again.progress.ended
        assert [row["answered"] for row in again.trials] == whole
        assert len([e for e in again.record.journal.events if e.kind == "answer"]) == len(kept)


def test_the_contrast_of_pictures_is_set_while_they_are_felt(tmp_path):
    session = begun(tmp_path)
    for stimulus in session.plan.stimuli():
        for contrast in (0.0, 0.3, 1.0):
            program = session.protocol.program(stimulus, Tuning(texture=1.0, contrast=contrast))
            room = room_for(session.protocol, session.plan, session.protocol.model.display)
            assert program.nbytes <= room
    said = sit(session, ("cue: practice 1", "begin"), ("cue: trial 1", "contrast 0.5"),
               ("contrast: 0.5", "c"), ("chosen", ""), ("answer: trial 1", "stop"))  # fmt: skip
    assert "contrast: 0.5" in said
    weak = [d.max() for line, _, d in frames(session.record) if line == 3]
    assert max(weak) <= 0.5 + 1e-6


def test_a_dataset_of_pictures_is_valid(tmp_path):
    session = begun(tmp_path)
    session.run("simulated:0")
    bids.write(session.record, tmp_path / "set")
    assert not complaints(tmp_path / "set")


def sit(session, *script):
    person = Person(list(script))
    session.run(person, say=person.said.append)
    return person.said


def test_an_answer_is_said_back_before_it_counts(tmp_path):
    session = begun(tmp_path)
    said = sit(
        session, ("cue: practice 1", "begin"), ("cue: trial 1", "c"), ("chosen: circle", "x"),
        ("no answer: 'x'", "s"), ("chosen: square", ""), ("answer: trial 1", "c"),
        ("chosen: circle", "circle"), ("answer: trial 2", "stop"),
    )  # fmt: skip
    answers = [event["answer"] for event in of(session.record.journal.events, "answer")]
    assert answers == ["square", "circle"]
    assert any("Enter takes it" in sentence for sentence in said)


def test_what_was_chosen_and_not_taken_is_not_in_the_record(tmp_path):
    session = begun(tmp_path)
    sit(session, ("cue: practice 1", "c"), ("chosen: circle", "stop"))
    assert not of(load(session.folder).journal.events, "answer")


THREE = TOML.replace(
    'choices = [{names = {c = "circle", s = "square"}}]',
    'buttons = true\nchoices = [{of = "shape", names = {c = "circle", s = "square"}},'
    ' {of = "size", names = {b = "big", l = "little"}}]',
).replace('kind = "list"\nstrings = ["circle", "square"]', 'kind = "items"') + (
    '[items]\nfile = "two.csv"\n'
)


class Pressing(BatchEngine):
    """An engine whose device has buttons pressed in turn, after the first stimulus is shown."""

    wanted = (1, 4, 3, 3)
    line = 0

    def show(self, picture, line):
        super().show(picture, line)
        self.line = line

    def poll(self):
        if self.line == 1 and self.wanted:
            self.device.press(self.wanted[0])
            self.device.let_go(self.wanted[0])
            self.wanted = self.wanted[1:]
        return super().poll()


def test_several_names_in_any_order_by_keys_or_buttons(tmp_path):
    (tmp_path / "two.csv").write_text(
        "string,shape,size\ncircle,circle,big\nsquare,square,little\n"
    )
    protocol = written(tmp_path, THREE)
    session = Session.create(
        protocol, "P1", folder=tmp_path / "s", seed=1, conditions=FAST,
        engine=lambda spec, wanted: Pressing(open_device(spec, wanted), poll_ticks=100),
    )  # fmt: skip
    said = sit(session, ("answer: practice 1", "begin"), ("cue: trial 1", "lc"),
               ("chosen: circle little", ""), ("answer: trial 1", "stop"))  # fmt: skip
    assert "chosen: circle; then one of b big, l little" in said
    assert "chosen: circle little; Enter takes it, another key changes it" in said
    answers = [event["answer"] for event in of(session.record.journal.events, "answer")]
    assert answers == ["circle big", "circle little"]
    rows = session.trials
    assert rows[0]["presented"] in ("circle big", "square little")
    assert {row["item_shape"] for row in rows} == {"circle", "square"}


@pytest.mark.parametrize(
    ("toml", "scene", "named"),
    [
        (TOML.replace("pantograph", "vbd"), SCENE, "model is 'vbd'"),
        (TOML.replace('"circle", "square"]', '"circle", "squire"]'), SCENE, "'squire'"),
        (TOML.replace('kind = "name"', 'kind = "identify"'), SCENE, "choices"),
        (TOML.replace("two.scene", "../two.scene"), SCENE, "scene"),
        (TOML.replace("two.scene", "none.scene"), SCENE, "there is no file"),
        (TOML, SCENE.replace("width_mm = 40", "width_mm = 400"), "400"),
        (TOML, SCENE + '[[elements]]\nkind="label"\ntext="a"\nplace_mm=[1, 1]\n', "labels"),
        (TOML, "[canvas", "two.scene is not TOML"),
        (TOML.replace('c = "circle", ', ""), SCENE, "names are 1"),
        (TOML.replace("repeats = 2", "repeats = 2\ncatch = {every = 2}"), SCENE, "catch"),
    ],
)
def test_what_cannot_be_shown_is_refused(tmp_path, toml, scene, named):
    assert named in refused(tmp_path, toml, scene)
