import json

import pytest
from httpx import Client
from starlette.types import Message, Receive, Scope, Send
from websockets.exceptions import ConnectionClosedError, InvalidStatus

from app.gate import LARGEST_BODY_BYTES, Gate
from tests.app.running import awaited

SOCKETS = ("/api/live", "/viewport")


def status_of(*headers: tuple[str, str], path: str = "/") -> int:
    """The gate's own answer, for headers that some HTTP servers refuse before it; 200 behind it."""

    async def page(scope: Scope, receive: Receive, send: Send) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def receive() -> Message:
        return {"type": "http.request", "body": b"", "more_body": False}

    async def send(message: Message) -> None:
        sent.append(message)

    sent: list[Message] = []
    raw = [(name.encode(), value.encode("latin-1")) for name, value in headers]
    awaited(Gate(page)({"type": "http", "path": path, "headers": raw}, receive, send))
    return sent[0]["status"]


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1.evil.example:8370", "", "[::", "0.0.0.0"]
)
@pytest.mark.parametrize("path", ["/", "/api/state", "/viewport/", "/openapi.json"])
def test_other_hosts_are_refused(client: Client, path: str, host: str) -> None:
    response = client.get(path, headers={"Host": host})
    assert response.status_code == 421
    assert "open the address that it printed" in response.json()["detail"]


@pytest.mark.parametrize("host", ["localhost:8370", "127.0.0.1", "[::1]:8370", "LOCALHOST"])
def test_loopback_names_are_answered(client: Client, host: str) -> None:
    assert client.get("/api/state", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:9999"])
def test_other_origins_may_order_nothing(client: Client, origin: str) -> None:
    before = client.get("/api/state").json()["run"]
    response = client.post("/api/playback", json={"action": "restart"}, headers={"Origin": origin})
    assert response.status_code == 403
    assert client.get("/api/state").json()["run"] == before


@pytest.mark.parametrize("path", SOCKETS)
@pytest.mark.parametrize(
    "stranger", [{"origin": "http://evil.example"}, {"origin": "null"}, {"host": "evil.example"}]
)
def test_sockets_refuse_strangers(link, path: str, stranger: dict[str, str]) -> None:
    with pytest.raises(InvalidStatus) as refused:
        link(path, **stranger)
    assert refused.value.response.status_code == 403


def test_our_own_origin_is_answered(client: Client, link) -> None:
    with link("/api/live", origin=str(client.base_url).rstrip("/")) as live:
        assert json.loads(live.recv(5))["frames"] == 4


def test_the_viewport_speaks_one_version_of_its_protocol(link) -> None:
    with pytest.raises(InvalidStatus):
        link("/viewport", subprotocols=["viser-v0.0.1"])


@pytest.mark.parametrize(
    "origin",
    ["", "http://[", "http://]", "//", "http://127.0.0.1:8370/", "http://a@127.0.0.1:8370"],
)
def test_origins_that_are_none_are_refused(origin: str) -> None:
    assert status_of(("host", "127.0.0.1:8370"), ("origin", origin)) == 403


def test_a_name_with_a_user_before_it_is_no_host() -> None:
    host = "evil@127.0.0.1:1"
    assert status_of(("host", host), ("origin", f"http://{host}")) == 421
    assert status_of(("host", "127.0.0.1:1/evil.example")) == 421


def test_no_header_counts_twice() -> None:
    host, origin = ("host", "127.0.0.1:1"), ("origin", "http://127.0.0.1:1")
    assert status_of(host, origin) == 200
    assert status_of(host, ("host", "evil.example"), origin) == 421
    assert status_of(host, host, origin) == 421
    assert status_of(host, origin, ("origin", "http://evil.example")) == 403
    assert status_of(origin) == 421


@pytest.mark.parametrize("length", ["9" * 5000, "-1", "1e3", "", "²", str(LARGEST_BODY_BYTES + 1)])
def test_lengths_that_are_none_or_too_large_are_refused(length: str) -> None:
    assert status_of(("host", "localhost"), ("content-length", length)) == 413


@pytest.mark.parametrize("length", ["0", "000", str(LARGEST_BODY_BYTES)])
def test_lengths_up_to_the_limit_are_taken(length: str) -> None:
    assert status_of(("host", "localhost"), ("content-length", length)) == 200


def test_text_in_the_viewports_link_ends_it_with_a_reason(client: Client, link) -> None:
    with link("/viewport", subprotocols=["viser-v1.1.1"]) as viewport:
        viewport.send("text")
        with pytest.raises(ConnectionClosedError) as closed:
            list(viewport)
    assert closed.value.rcvd.code == 1003
    assert closed.value.rcvd.reason == "The viewport takes binary messages only."


def test_the_live_link_heeds_nothing_that_a_page_sends(client: Client, link) -> None:
    with link("/api/live") as live:
        live.recv(5)
        live.send(b"\0")
        live.send("text")
        client.post("/api/shown", json={"frame": 2})
        assert json.loads(live.recv(5))["shown"] == 2
        client.post("/api/shown", json={"frame": None})


def test_large_bodies_are_refused_with_and_without_a_length(client: Client) -> None:
    body = b'{"action": "' + b"x" * LARGEST_BODY_BYTES + b'"}'
    headers = {"Content-Type": "application/json"}
    response = client.post("/api/playback", content=body, headers=headers)
    assert response.status_code == 413
    chunked = client.post("/api/playback", content=iter([body]), headers=headers)
    assert chunked.status_code >= 400


@pytest.mark.parametrize(
    "path", ["/../pyproject.toml", "/%2e%2e/pyproject.toml", "/..%2fapp/web.py", "//etc/passwd"]
)
def test_only_the_pages_own_files_are_given(client: Client, path: str) -> None:
    assert client.get(path).status_code == 404


def test_the_page_may_load_from_its_origin_only(client: Client) -> None:
    headers = client.get("/").headers
    assert "script-src 'self'" in headers["Content-Security-Policy"]
    assert "frame-ancestors 'none'" in headers["Content-Security-Policy"]
    assert headers["X-Content-Type-Options"] == "nosniff"
    viewport = client.get("/viewport/").headers["Content-Security-Policy"]
    assert "script-src 'sha256-" in viewport
    assert "connect-src 'self' data: blob:" in viewport
    assert "unsafe-eval'" in viewport
    assert " 'unsafe-eval'" not in viewport
