import json

import pytest
from httpx import Client
from websockets.exceptions import InvalidStatus

from app.gate import LARGEST_BODY_BYTES

SOCKETS = ("/api/live", "/viewport")


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
