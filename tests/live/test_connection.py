"""The talk with a page: what it may ask, what it is told, and how it ends."""

import json

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.exceptions import ConnectionClosed

from tests.live.canned import COUNT, CannedSource, canned_frame, canned_state
from tests.live.pages import page, served
from tests.tiers import examples, heavy
from vbraille.errors import InputError
from vbraille.live.messages import MOST_BYTES, VERSION, LetGo, PagePress, Point, Turn


@pytest.fixture
def source():
    return CannedSource()


@pytest.fixture
def server(source):
    with served(source) as running:
        yield running


@pytest.fixture
def address(server):
    return server.admission.steering_address


@pytest.fixture
def watching(server):
    return server.admission.watching_address


@pytest.fixture(scope="module")
def steady():
    """A server that many examples share."""
    with served(CannedSource()) as running:
        yield running.admission.steering_address


def closed(opened):
    """What a page is told last; its connection must be closed then."""
    said = opened.hear()
    with pytest.raises(ConnectionClosed) as ended:
        opened.connection.recv(20)
    assert ended.value.rcvd.code == 1008
    assert said["tell"] == "refused"
    return said["why"]


def test_the_welcome_says_what_a_page_may(address, watching):
    for opened_by, steers in ((address, True), (watching, False)):
        with page(opened_by, greets=False) as opened:
            assert opened.hello(opened_by.partition("#")[2]) == {
                "tell": "welcome", "version": VERSION, "steers": steers, "playback": False,
                "length_s": 0.0, "moments": [],
            }  # fmt: skip


def test_frames_come_as_they_are_and_the_state_before_the_first_only(address, source):
    with page(address) as opened:
        frames = [opened.bytes_of_frame() for _ in range(5)]
        assert frames == [canned_frame(n) for n in range(5)]
        assert opened.states == 1
        assert opened.state == json.loads(source.told[1])


def test_a_state_comes_with_the_next_pull_only_when_it_has_changed(address, source):
    with page(address) as opened, page(address) as other:
        opened.frame(), other.frame()
        source.show(canned_state(2, title="another text"))
        assert opened.frame().header["state"] == 2
        assert opened.state["title"] == "another text"
        opened.frame(), other.frame()
        assert (opened.states, other.states) == (2, 2)


def test_each_page_has_frames_of_its_own(address):
    with page(address) as opened, page(address) as other:
        for _ in range(3):
            opened.frame()
        assert other.bytes_of_frame() == canned_frame(0)
        assert opened.bytes_of_frame() == canned_frame(3)


def test_a_frame_that_there_is_not_is_waited_for_and_comes_at_last(address, source):
    source.silent = True
    with page(address) as opened:
        opened.frame()  # a state that is new is not waited with
        opened.say("next")
        with pytest.raises(TimeoutError):
            opened.connection.recv(0.1)
        assert isinstance(opened.connection.recv(20), bytes)  # the old one, after a second


def test_a_new_state_is_told_while_a_frame_is_waited_for(address, source):
    source.silent = True
    with page(address) as opened:
        opened.frame()
        opened.say("next")
        source.show(canned_state(2))
        assert opened.hear()["number"] == 2
        assert isinstance(opened.connection.recv(20), bytes)


def test_whoever_steers_does_not_wait_for_a_frame(address, source):
    source.silent = True
    with page(address) as opened:
        opened.frame()
        opened.say("next")
        opened.say("next")
        opened.say("press", command="next line")
        opened.say("map")
        assert opened.connection.recv(20)[0] == 2  # the map, before the frame
        assert source.asked == [PagePress("next line")]


def test_frames_may_be_asked_for_ahead(address):
    with page(address) as opened:
        for _ in range(50):
            opened.say("next")
        assert opened.hear()["tell"] == "state"
        assert [opened.connection.recv(20) for _ in range(50)] == [
            canned_frame(n) for n in range(50)
        ]


def test_what_is_steered_arrives_in_its_order(address, source):
    asked = [PagePress("next line"), Turn("contrast", 0.5), Point(1.0, 2.0, 0.1), LetGo()]
    with page(address) as opened:
        for request in asked:
            opened.connection.send(msgspec.json.encode(request), text=True)
        opened.frame()
        assert source.asked == asked


def test_who_only_watches_steers_nothing_and_watches_on(watching, source):
    with page(watching) as opened:
        opened.say("point", x_mm=3.0)
        opened.say("press", command="quit")
        for _ in range(2):
            assert "may only watch" in opened.hear()["why"]
        assert opened.frame().header["rows"] == 6
    assert source.asked == []


def test_where_nobody_steers_the_token_does_not_help(source):
    with served(source, steers=False) as server:
        token = server.admission.steer_token
        address = f"{server.admission.steering_address}#{token}"
        with page(address) as opened:
            opened.say("point", x_mm=3.0)
            assert "may only watch" in opened.hear()["why"]


@pytest.mark.parametrize("token", ["wrong", "é" * 200], ids=ascii)
def test_a_wrong_token_ends_the_talk_with_a_sentence(address, token):
    with page(address, greets=False) as opened:
        opened.say("hello", token=token)
        assert "open the address that vbraille said" in closed(opened)


def test_without_an_origin_a_token_is_needed(address, watching):
    with page(watching, origin=None, greets=False) as opened:
        opened.say("hello")
        assert "token" in closed(opened)
    with page(address, origin=None) as opened:
        assert opened.frame().header["rows"] == 6


def test_the_hand_is_let_go_with_the_last_page_that_moved_it(address, source):
    with page(address) as opened:
        with page(address) as other:
            other.say("point", x_mm=1.0)
            other.frame()
            opened.say("point", x_mm=2.0)
            opened.frame()
        while_it_is_gone = opened.frame()
        assert while_it_is_gone.header["rows"] == 6
        assert LetGo() not in source.asked
        opened.connection.socket.close()  # in the middle of it all
    with page(address) as last:
        for _ in range(1000):
            last.frame()
            if LetGo() in source.asked:
                break
    assert source.asked == [Point(1.0), Point(2.0), LetGo()]


@pytest.mark.parametrize("form", ["png", "svg"])
def test_a_map_comes_as_a_file(address, source, form):
    with page(address) as opened:
        is_svg, file = opened.map(form)
        assert is_svg == (form == "svg")
        assert file.startswith(b"<svg" if is_svg else b"\x89PNG")
        source.show(canned_state(2, blind=True))
        opened.say("map")
        assert opened.hear()["why"] == "a blind session shows no map"
        opened.say("map", form="pdf")
        assert 'ask for "png" or "svg"' in opened.hear()["why"]
        assert opened.frame().header["rows"] == 6


class Faulty(CannedSource):
    """A source whose maps and states are not as they should be."""

    def map(self, request):
        raise ZeroDivisionError(request.form)

    def ask(self, request):
        raise InputError(f"nothing obeys {type(request).__name__}; give ‹device› another")


def test_what_a_source_cannot_do_is_a_sentence_and_the_talk_goes_on():
    with served(Faulty()) as server, page(server.admission.steering_address) as opened:
        opened.say("let-go")
        assert opened.hear()["why"] == "nothing obeys LetGo; give --device another"
        opened.say("map")
        assert opened.hear()["why"].startswith("the map could not be drawn")
        assert opened.frame().header["rows"] == 6


class Broken(CannedSource):
    """A source without frames."""

    frames = ()

    def show(self, state):
        super().show(state)
        self.frames = ()


def test_a_fault_of_the_source_ends_that_page_with_a_sentence():
    with served(Broken()) as server:
        for _ in range(2):
            with page(server.admission.steering_address) as opened:
                opened.say("next")
                assert "a fault of vbraille's own" in closed(opened)


def test_a_recording_is_shown_at_the_times_that_are_asked_for():
    with (
        served(CannedSource(playback=True)) as server,
        page(server.admission.watching_address, greets=False) as opened,
    ):
        welcome = opened.hello()
        assert (welcome["playback"], welcome["length_s"]) == (True, COUNT / 60)
        assert welcome["moments"][0] == {
            "at_s": 0.5, "kind": "line", "text": "line 1", "right": None, "condition": ""
        }  # fmt: skip
        assert opened.bytes_of_frame(at_s=0.5) == canned_frame(30)


ASCII = st.characters(max_codepoint=127)
GARBAGE = [
    "", "no JSON", "{", "[]", "null", "1", '"next"', "{}", '{"ask":"nothing"}', '{"ask":1}',
    '{"ask":"next","row":"1"}', '{"ask":"next","row":1.5}', '{"ask":"next","more":1}',
    '{"ask":"point"}', '{"ask":"point","x_mm":null}', '{"ask":"point","x_mm":NaN}',
    '{"ask":"point","x_mm":1e999}', '{"ask":"turn","knob":1,"value":1}', '{"ask":"next"}{}',
    '{"ask":"hello"}', "[" * 4000, '{"ask":"press","command":"\\ud800"}', b"\x01\x02", b"",
]  # fmt: skip


@pytest.mark.parametrize("garbage", GARBAGE, ids=lambda text: ascii(text[:40]))
def test_garbage_is_refused_once_and_ends_the_talk(steady, garbage):
    with page(steady) as opened:
        opened.connection.send(garbage)
        assert "\n" not in closed(opened)
    with page(steady) as opened:
        assert opened.frame().header["rows"] == 6


@pytest.mark.parametrize("first", ['{"ask":"next"}', '{"ask":"point","x_mm":1}', "x"])
def test_the_first_message_is_hello(steady, first):
    with page(steady, greets=False) as opened:
        opened.connection.send(first)
        assert closed(opened)


@pytest.mark.parametrize(
    ("message", "code"), [("x" * (MOST_BYTES + 1), 1009), ("é" * MOST_BYTES, 1009)], ids=ascii
)
def test_what_is_too_long_ends_the_connection(steady, message, code):
    with page(steady) as opened:
        opened.connection.send(message)
        with pytest.raises(ConnectionClosed) as ended:
            opened.connection.recv(20)
        assert ended.value.rcvd.code == code


@pytest.mark.parametrize(
    "sent",
    [b"\x00" * 100, b"\xff" * 2000, b"GET / HTTP/1.1\r\n\r\n", b"\x81\x85\x00\x00\x00\x00\xff\xfe",
     b"\x89\xff", b"\xc1\x80\x00\x00\x00\x00"],
    ids=["zeros", "ones", "http", "no utf-8", "ping", "compressed"],
)  # fmt: skip
def test_what_is_no_websocket_ends_that_connection_alone(steady, sent):
    with page(steady) as opened, page(steady) as other:
        opened.connection.socket.sendall(sent)
        opened.connection.socket.close()
        assert other.frame().header["rows"] == 6


@examples(30)
@given(st.text(ASCII, max_size=200) | st.recursive(
    st.none() | st.booleans() | st.floats() | st.text(ASCII, max_size=20),
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(st.sampled_from(["ask", "row", "x_mm", "token", "a"]), inner, max_size=3),
    max_leaves=5,
).map(json.dumps))  # fmt: skip
def test_no_text_does_more_than_end_its_own_talk(steady, text):
    with page(steady) as opened:
        opened.connection.send(text)
        assert closed(opened).startswith(("that is no request", "hello is said once"))


def test_a_page_that_stops_reading_holds_up_nobody_and_gets_no_more(server, address):
    with page(address) as stalled, page(address) as opened:
        stalled.connection.socket.settimeout(0.05)
        # More requests than any buffer takes answers of: then the server takes no more of them.
        request = bytes([0x81, 0x80 | 14, 0, 0, 0, 0]) + b'{"ask":"next"}'
        with pytest.raises(TimeoutError):
            stalled.connection.socket.sendall(request * 1_000_000)
        assert opened.frame().header["rows"] == 6
        stalled.connection.socket.close()
    assert server.pages <= 2


@heavy  # it waits for five seconds
def test_a_page_that_says_nothing_is_not_waited_for_long(address):
    with page(address, greets=False) as opened:
        assert "nothing was said for 5 s" in closed(opened)
