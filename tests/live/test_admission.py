"""Who may watch and steer, and by which names a server is called."""

import os
import socket

import pytest

from vbraille.live.admission import Admission, Right, owner_of, reachable

HERE = Admission("127.0.0.1", 4000)
THERE = Admission("192.0.2.7", 4000)


def test_watching_on_loopback_needs_nothing_and_steering_its_token():
    assert HERE.right("", from_page=True) is Right.WATCH
    assert HERE.right(HERE.watch_token, from_page=True) is Right.WATCH
    assert HERE.right(HERE.steer_token, from_page=True) is Right.STEER


def test_what_is_no_page_needs_a_token_on_loopback_too():
    assert HERE.right("", from_page=False) is Right.NONE
    assert HERE.right(HERE.watch_token, from_page=False) is Right.WATCH


def test_elsewhere_watching_needs_a_token():
    assert THERE.right("", from_page=True) is Right.NONE
    assert THERE.right(THERE.watch_token, from_page=True) is Right.WATCH
    assert THERE.right(THERE.steer_token, from_page=True) is Right.STEER


def test_on_loopback_only_the_user_who_reads_and_root_may_connect():
    own = os.getuid()
    for owner in (own, 0, None):
        assert HERE.is_for(owner)
    assert not HERE.is_for(own + 1)
    assert THERE.is_for(own + 1)


@pytest.mark.parametrize(
    ("family", "host"), [(socket.AF_INET, "127.0.0.1"), (socket.AF_INET6, "::1")]
)
def test_the_owner_of_a_connection_is_known(family, host):
    with (
        socket.create_server((host, 0), family=family) as server,
        socket.create_connection(server.getsockname()[:2]) as client,
    ):
        accepted, peer = server.accept()
        with accepted:
            assert owner_of(peer, accepted.getsockname()) == os.getuid()
            assert owner_of((peer[0], peer[1], 1), (host, 1)) is None
        assert owner_of(client.getpeername(), ("192.0.2.1", 1)) is None


@pytest.mark.parametrize("token", ["wrong", " ", "é", "\ud800"], ids=ascii)
def test_a_wrong_token_gives_nothing_even_on_loopback(token):
    assert HERE.right(token, from_page=True) is Right.NONE
    assert HERE.right(HERE.steer_token[:-1], from_page=True) is Right.NONE


def test_where_nobody_steers_the_token_only_lets_watch():
    still = Admission("127.0.0.1", 4000, steers=False)
    assert still.right(still.steer_token, from_page=True) is Right.WATCH
    assert still.steering_address == still.watching_address == "http://127.0.0.1:4000/"


def test_tokens_are_others_each_time_and_long():
    tokens = {a for one in (HERE, THERE) for a in (one.watch_token, one.steer_token)}
    assert len(tokens) == 4
    assert min(map(len, tokens)) >= 20
    assert not any(token in repr((HERE, THERE)) for token in tokens)


def test_addresses_have_their_tokens_behind_the_hash():
    assert HERE.steering_address == f"http://127.0.0.1:4000/#{HERE.steer_token}"
    assert HERE.watching_address == "http://127.0.0.1:4000/"
    assert THERE.steering_address == f"http://192.0.2.7:4000/#{THERE.steer_token}"
    assert THERE.watching_address == f"http://192.0.2.7:4000/#{THERE.watch_token}"
    assert Admission("::1", 80).watching_address == "http://[::1]/"


@pytest.mark.parametrize(
    "host", ["127.0.0.1:4000", "localhost:4000", "LOCALHOST:4000", "[::1]:4000"]
)
def test_names_of_loopback(host):
    assert HERE.is_ours(host, "127.0.0.1")
    assert not THERE.is_ours(host, "192.0.2.7")


@pytest.mark.parametrize(
    "host",
    ["", "127.0.0.1", "127.0.0.1:4001", "evil.example:4000", "127.0.0.1.evil.example:4000",
     "localhost", "192.0.2.7:4000", "127.0.0.1:4000@evil.example"],
)  # fmt: skip
def test_other_names_are_not_ours_on_loopback(host):
    assert not HERE.is_ours(host, "127.0.0.1")


def test_names_elsewhere():
    anywhere = Admission("0.0.0.0", 4000)
    own = socket.gethostname()
    for host in ("192.0.2.9:4000", f"{own}:4000", f"{own}.local:4000"):
        assert anywhere.is_ours(host, "192.0.2.9")
    assert not anywhere.is_ours("evil.example:4000", "192.0.2.9")
    assert not anywhere.is_ours("192.0.2.8:4000", "192.0.2.9")
    assert anywhere.is_ours("localhost:4000", "127.0.0.1")


def test_the_port_of_http_may_be_left_out():
    assert Admission("127.0.0.1", 80).is_ours("localhost", "127.0.0.1")


def test_an_address_that_others_reach_is_said():
    assert reachable("192.0.2.7") == "192.0.2.7"
    assert reachable("lab.example") == "lab.example"
    assert reachable("0.0.0.0") != "0.0.0.0"
