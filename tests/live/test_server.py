"""The server's door: files, headers, names, origins, and how many come in."""

import os
import socket
import subprocess
import sys
from contextlib import ExitStack

import pytest
from websockets.exceptions import InvalidStatus

from tests.live.canned import CannedSource
from tests.live.pages import get, page, parts_of, served
from tests.tiers import by_tier
from vbraille.errors import InputError
from vbraille.live.server import HEADERS, MOST_CONNECTIONS, MOST_PAGES, page_files


@pytest.fixture(scope="module")
def server():
    with served(CannedSource()) as running:
        yield running


@pytest.fixture
def address(server):
    return server.admission.steering_address


def test_every_file_of_the_page_is_served_as_it_is(address):
    files = page_files()
    for path, (kind, content) in files.items():
        status, body, headers = get(address, path)
        assert (status, headers["Content-Type"]) == (200, kind)
        assert body.encode() == content or kind == "image/png"


@pytest.mark.parametrize("path", ["/", "/nothing", "/../server.py", "/%2e%2e/server.py", "/live"])
def test_every_answer_has_the_headers_of_safety(address, path):
    _, _, headers = get(address, path)
    for name, value in HEADERS:
        assert headers[name] == value
    assert "Server" not in headers


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can be another user for a while")
def test_another_user_of_this_machine_is_shown_nothing_even_with_the_token(server, address):
    script = (
        "import json, os, sys\n"
        "from websockets.sync.client import connect\n"
        "from websockets.exceptions import InvalidStatus\n"
        "os.setuid(65534)\n"
        "try:\n"
        "    with connect(sys.argv[1], origin=sys.argv[2], compression=None) as page:\n"
        "        page.send(json.dumps({'ask': 'hello', 'token': sys.argv[3]}))\n"
        "        print(page.recv(20))\n"
        "except InvalidStatus as refused:\n"
        "    print(refused.response.status_code, refused.response.body.decode())\n"
    )
    origin, token = address.split("/#")
    live = f"{origin.replace('http', 'ws', 1)}/live"
    for given in ("", token):
        asked = [sys.executable, "-c", script, live, origin, given]
        said = subprocess.run(asked, check=True, capture_output=True, text=True).stdout
        assert said.startswith("403 another user of this machine reads here")
    with page(server.admission.watching_address) as opened:
        assert opened.frame().header["rows"] == 6


def test_the_policy_lets_nothing_in_from_outside():
    policy = dict(HEADERS)["Content-Security-Policy"]
    assert policy == (
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
        "img-src 'self' blob: data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    assert dict(HEADERS)["Cache-Control"] == "no-store"
    assert dict(HEADERS)["Referrer-Policy"] == "no-referrer"
    assert dict(HEADERS)["X-Content-Type-Options"] == "nosniff"


@pytest.mark.parametrize("path", ["/nothing", "/../server.py", "/server.py", "//", "/index.html?x"])
def test_there_are_no_other_files(address, path):
    assert get(address, path)[0] == 404


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "HEAD"])
def test_nothing_but_get(address, method):
    assert get(address, method=method)[0] == 405


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1"])
def test_another_name_is_refused_for_files_and_pages(address, host):
    status, body, _ = get(address, Host=host)
    assert status == 421
    assert "open the address that vbraille said" in body
    with pytest.raises(InvalidStatus) as refused, page(address, host=host):
        pass
    assert refused.value.response.status_code == 421


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"]
)
def test_a_page_of_another_origin_is_refused_even_with_the_token(address, origin):
    with pytest.raises(InvalidStatus) as refused, page(address, origin=origin):
        pass
    assert refused.value.response.status_code == 403


def test_the_origin_is_that_of_the_name_it_was_called_by(address):
    _, port, _ = parts_of(address)
    name = f"localhost:{port}"
    with page(address, host=name, origin=f"http://{name}") as opened:
        assert opened.frame().header["rows"] == 6
    with pytest.raises(InvalidStatus), page(address, host=name):
        pass


def test_a_page_too_many_is_told_a_sentence():
    with served(CannedSource()) as server, ExitStack() as stack:
        address = server.admission.steering_address
        first = stack.enter_context(page(address))
        for _ in range(MOST_PAGES - 1):
            stack.enter_context(page(address))
        with pytest.raises(InvalidStatus) as refused, page(address):
            pass
        assert refused.value.response.status_code == 503
        assert b"32 pages are open" in refused.value.response.body
        assert first.frame().header["columns"] == 10


def test_very_many_connections_that_say_nothing():
    with served(CannedSource()) as server, ExitStack() as stack:
        address = server.admission.steering_address
        host, port, _ = parts_of(address)
        watching = stack.enter_context(page(address))
        silent, told = [], 0
        for _ in range(by_tier(300, 1000, 1000)):
            silent.append(stack.enter_context(socket.create_connection((host, port))))
            if len(silent) > MOST_CONNECTIONS:  # of those the server thinks no more
                one = silent.pop()
                # On a busy machine the first were sent away by now, and this one comes in.
                told += b"503" in one.recv(100)
                one.close()
        assert told
        assert watching.frame().header["columns"] == 10
        for one in silent[:10]:
            one.close()
        assert get(address)[0] in (200, 404, 503)


def test_a_port_in_use_is_one_sentence():
    with served(CannedSource()) as server:
        port = server.admission.port
        said = rf"^port {port} is in use; give .port. another"
        with pytest.raises(InputError, match=said), served(CannedSource(), port=port):
            pass


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"host": "192.0.2.1"}, "192.0.2.1 is not an address of this machine"),
        ({"host": "nowhere.invalid"}, "'nowhere.invalid' is no name or address of this machine"),
        ({"host": ""}, "'' is no name or address"),
        ({"port": 70000}, "there is no port 70000"),
        ({"host": "a" * 70 + ".example"}, "is no name or address"),
    ],
    ids=["elsewhere", "unknown", "empty", "port", "long"],
)
def test_where_nobody_can_listen_is_one_sentence(options, said):
    with pytest.raises(InputError, match=said), served(CannedSource(), **options):
        pass
