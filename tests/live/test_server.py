"""Server of the live view: rights of pages, host names, how many pages; frames and states sent."""

import os
import socket
from contextlib import ExitStack

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from tests.live.showing import MASKS, Client, Reading, get, split
from vbraille.errors import InputError
from vbraille.live.admission import owner_of
from vbraille.live.messages import LetGo, PagePress, Point
from vbraille.live.server import MOST_CONNECTIONS, MOST_PAGES
from vbraille.live.view import LiveView


@pytest.fixture(scope="module")
def reading():
    with Reading() as reading:
        yield reading


@pytest.fixture
def address(reading):
    return reading.address


def refusal(client):
    """The sentence with which a page is not let in."""
    with client as opened:
        assert opened.welcome["tell"] == "refused"
        with pytest.raises(ConnectionClosed):
            opened.hear()
        return opened.welcome["why"]


def test_frames_are_the_engines(reading, address):
    with Client(address) as page:
        assert page.welcome == {
            "tell": "welcome", "steers": True, "playback": False, "length_s": 0.0, "moments": [],
        }  # fmt: skip
        header, deflections = page.frame()
        assert page.state["title"] == "A story"
        assert page.state["lines"][1]["cells"] == MASKS.tolist()
        np.testing.assert_array_equal(deflections, reading.frame())
        after, _ = page.frame()
        assert after["tick"] > header["tick"]
        assert after["x_mm"] == np.float32(reading.x_mm)
        assert after["state"] == page.state["number"]


def test_a_page_steers_and_what_it_holds_is_let_go_when_it_goes(reading, address):
    with Client(address) as page:
        page.ask(ask="point", x_mm=12.5)
        page.until(lambda header, _: header["x_mm"] == 12.5)
        page.ask(ask="press", command="LNDN")
        page.until(lambda _, state: state["said"][-1] == "line: 3")
        assert page.state["held"]
        page.ask(ask="point", x_mm=float("inf"))
    with Client(address) as page:
        page.until(lambda _, state: not state["held"])
    assert reading.asked[0] == Point(12.5)
    assert PagePress("LNDN") in reading.asked
    assert reading.asked[-1] == LetGo()


def test_rights_follow_the_token(address):
    name, port, _ = split(address)
    base = f"http://{name}:{port}/"
    with Client(base) as page:  # the same user, by a page of this server
        assert not page.welcome["steers"]
        page.ask(ask="turn", knob="texture", value=0.3)
        assert "only watch" in page.hear()["why"]
        assert page.frame()[0]["rows"] == 6
    assert "token" in refusal(Client(base, token="another"))
    assert "token" in refusal(Client(base, origin=None))  # a program that is no page
    with Client(address, origin=None) as page:
        assert page.welcome["steers"]


def test_other_names_and_other_sites_are_refused(address):
    _, port, _ = split(address)
    assert get(address, Host=f"evil.example:{port}")[0] == 421
    assert get(address, Host=f"localhost:{port}")[0] == 200
    for origin in ("http://evil.example", f"https://127.0.0.1:{port}", "null"):
        with pytest.raises(InvalidStatus) as refused, Client(address, origin=origin):
            pass
        assert refused.value.response.status_code == 403


def test_answers_have_the_headers_of_safety(address):
    for path, status in (("/", 200), ("/main.js", 200), ("/none", 404), ("/../view.py", 404)):
        code, _, headers = get(address, path)
        assert code == status
        assert headers["Content-Security-Policy"].startswith("default-src 'none'; script-src 's")
        assert headers["X-Content-Type-Options"] == "nosniff"
        assert headers["Cache-Control"] == "no-store"
    assert get(address, method="POST")[0] == 405


def test_the_owner_of_a_connection_is_known():
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        socket.create_connection(server.getsockname()),
    ):
        accepted, peer = server.accept()
        with accepted:
            assert owner_of(peer, accepted.getsockname()) == os.getuid()
        assert owner_of((peer[0], 1), ("127.0.0.1", 1)) is None


def test_another_user_is_refused(address, monkeypatch):
    monkeypatch.setattr("vbraille.live.server.owner_of", lambda *_: 4711)
    assert get(address)[0] == 403


@pytest.mark.parametrize(
    "said", ["{", '{"ask": "map"}', '{"ask": "next", "at_s": "x"}', "[" * 4000]
)
def test_what_is_no_request_ends_the_talk_with_a_sentence(address, said):
    with Client(address) as page:
        page._socket.send(said)
        assert page.hear()["tell"] == "refused"
        with pytest.raises(ConnectionClosed):
            page.hear()


def test_a_blind_view_hides_what_is_felt_for_good():
    with Reading(blind=True) as reading, Client(reading.address) as page:
        header, deflections = page.frame()
        assert deflections.size == 0
        assert header["x_mm"] == 40.0
        assert page.state["blind"]
        assert page.state["lines"] == page.state["rows_shown"] == []


def test_too_many_pages_and_connections_do_not_keep_the_others_waiting(address):
    name, port, _ = split(address)
    with ExitStack() as stack:
        pages = [stack.enter_context(Client(address)) for _ in range(MOST_PAGES)]
        with pytest.raises(InvalidStatus) as refused, Client(address):
            pass
        assert refused.value.response.status_code == 503
        for _ in range(MOST_CONNECTIONS):
            stack.enter_context(socket.create_connection((name, port)))
        assert pages[0].frame()[0]["rows"] == 6


@pytest.mark.parametrize(
    ("options", "names"),
    [
        ({"host": "192.0.2.1"}, "192.0.2.1"),
        ({"host": "nowhere.invalid"}, "nowhere.invalid"),
        ({"host": ""}, "''"),
        ({"port": 70000}, "70000"),
    ],
)
def test_where_it_cannot_listen_is_one_sentence(options, names):
    with pytest.raises(InputError, match=names), LiveView(**options):
        pass


def test_a_port_in_use_is_one_sentence(address):
    _, port, _ = split(address)
    with pytest.raises(InputError, match=f"port {port} is in use"), LiveView(port=port):
        pass
