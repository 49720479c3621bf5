"""Words and sounds of elements: said and played once when the finger comes to them."""

import wave

import numpy as np
import pytest

from tests.reading.felt import SCENE, Felt
from tests.reading.test_cues import Loudspeaker, given
from vbraille.errors import InputError
from vbraille.feeling.loading import load_scene
from vbraille.reading.outputs import CueKind
from vbraille.reading.view import Cue, SoundFile
from vbraille.render.braille.models import STRESS2
from vbraille.sounds import MOST_BYTES, read_sound


def write_sound(path, samples, width=2, channels=1):
    kind = {1: "u1", 2: "<i2", 3: "u1", 4: "<i4"}[width]
    with wave.open(str(path), "wb") as file:
        file.setparams((channels, width, 8000, 0, "NONE", ""))
        file.writeframes(np.asarray(samples, kind).tobytes())


@pytest.fixture
def path(tmp_path):
    write_sound(tmp_path / "sun.wav", [0, 16384, -32768])
    path = tmp_path / "house.scene"
    named = 'title = "Sun"\nwords = "the sun"\nsound = "sun.wav"'
    path.write_text(SCENE.replace('title = "Sun"', named))
    return path


def felt_with_sounds(path, **how):
    felt, played = Felt(path, **how), []
    felt.feeler._sound = played.append
    return felt, played


def test_off_words_and_all(path):
    felt, played = felt_with_sounds(path)
    assert felt.be_at(90, 20) == []
    felt.be_at(115, 85)
    assert felt.press("v") == ["entering: said"]
    assert felt.be_at(90, 20) == ["the sun"]
    felt.be_at(115, 85)
    assert not played
    assert felt.press("v") == ["entering: said, with sounds"]
    assert felt.be_at(90, 20) == ["the sun"]
    assert felt.be_at(91, 20) == []
    assert played == [path.parent / "sun.wav"]
    assert felt.be_at(60, 50) == ["leaving: Sun", "entering: wall"]
    assert felt.be_at(90, 20)[-1] == "the sun"
    assert len(played) == 2
    assert felt.press("v") == ["entering: not said"]


def test_where_nothing_plays_sounds_there_are_words_alone(path):
    felt = Felt(path, entering=True)
    assert felt.press("v") == ["entering: not said"]


def test_the_names_of_sounds_are_seen_from_their_file(path):
    other = path.parent / "deep" / "other.scene"
    other.parent.mkdir()
    other.write_text('include = ["../house.scene"]\ncanvas = { width_mm = 99, height_mm = 99 }')
    loaded = load_scene(other, STRESS2.style)
    sound = loaded.opened.folder / loaded.scene.elements[0].sound
    assert sound.resolve() == (path.parent / "sun.wav").resolve()


def vast(path):
    with path.open("wb") as file:
        file.truncate(1_000_000_000)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda path: path.unlink(), "cannot be read: No such file"),
        (vast, "has 1000 MB; 10 are the most"),
        (lambda path: path.write_text("la la la"), "is no WAV file"),
        (lambda path: path.write_bytes(b""), "is no WAV file"),
        (lambda path: write_sound(path, [1] * 9, width=3), "is no WAV file"),
        (lambda path: (path.unlink(), path.mkdir()), "is no file"),
    ],
    ids=["missing", "1 GB", "no audio", "empty", "24 bits", "a folder"],
)
def test_what_cannot_be_played_is_one_sentence_with_its_line(path, make, said):
    make(path.parent / "sun.wav")
    with pytest.raises(InputError, match=rf"house.scene line \d+: sound .*{said}") as raised:
        load_scene(path, STRESS2.style)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("width", [1, 2, 4])
def test_samples_are_from_minus_one_to_one(tmp_path, width):
    full = 2 ** (8 * width - 1)
    middle = 128 if width == 1 else 0
    write_sound(tmp_path / "a.wav", [middle, middle + full // 2, middle - full, middle], width, 2)
    samples, rate_hz = read_sound(tmp_path / "a.wav")
    assert rate_hz == 8000
    np.testing.assert_allclose(samples, [[0, 0.5], [-1, 0]])


def test_the_largest_is_a_minute():
    assert MOST_BYTES > 44_100 * 2 * 2 * 55


@pytest.mark.parametrize("kind", CueKind)
def test_the_process_of_cues_plays_files_whatever_cues_are_given_by(kind):
    class Speaker(Loudspeaker):
        def play_file(self, path):
            self.played.append(path.name)

    speaker = Speaker()
    assert list(given([SoundFile("/a/sun.wav")], kind.value, speaker))
    assert speaker.played == ["sun.wav"]


def test_without_audio_output_the_process_goes_on():
    assert len(list(given([SoundFile("/a/sun.wav"), Cue.LIMIT], "none"))) == 2
