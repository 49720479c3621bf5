"""The table of keys for those who feel a picture, against its document."""

import pytest

from tests.reading.felt import SCENE, Felt
from vbraille.reading.commands.scene import BOUND, BUTTONS
from vbraille.reading.keys import Context


@pytest.mark.parametrize("context", Context)
def test_a_key_has_one_meaning_in_a_context(context):
    keys = [key for command in BOUND.of(context) for key in command.keys]
    assert len(set(keys)) == len(keys) > 0


def test_every_command_says_something_or_moves_the_hand_or_ends(tmp_path):
    path = tmp_path / "house.scene"
    path.write_text(SCENE)
    felt = Felt(path)
    for command in BOUND.of(Context.READING):
        if command.name not in ("CANCEL", "MIDDLE", "QUIT"):
            felt.feeler.context = Context.READING
            assert felt.press(command.keys[0]) or felt.wait(), command.name


def test_buttons_call_commands_that_there_are():
    assert {BOUND.buttons[int(number)].name for number in BUTTONS} == set(BUTTONS.values())
