import httpx
import pytest

PAGE = "/api/viewport/picking-page/picking"
ABOVE = [0.0, 0.0, -30.0]


@pytest.fixture
def page(client: httpx.Client):
    yield client
    client.delete(PAGE)
    client.delete("/api/measurements")


def click(client: httpx.Client, x: float, y: float) -> httpx.Response:
    ray = {"origin_m": [x, y, -30.0], "direction": [0.0, 0.0, 1.0]}
    return client.post(f"{PAGE}/picks", json=ray)


def test_rays_pick_as_clicks_do_and_the_state_tells(page: httpx.Client) -> None:
    answer = page.put(PAGE, json={"kind": "length", "snap": "part end"}).json()["picking"]
    assert answer["hint"].startswith("Length: click the first end")
    assert page.get("/api/state").json()["picking"]["picking-page"] == answer
    assert click(page, -3.0, 0.0).json()["picking"]["picked"] == 1
    assert "no hull" in click(page, 11.0, 11.0).json()["picking"]["complaint"]
    assert page.delete(f"{PAGE}/picks/last").json()["picking"]["picked"] == 0
    names = {item["name"] for item in page.get("/api/state").json()["measurements"]["items"]}
    click(page, 2.2, -6.5)
    click(page, 2.2, 6.5)
    items = page.get("/api/state").json()["measurements"]["items"]
    assert len(items) == len(names) + 1
    assert page.delete(PAGE).json() == {"picking": None}
    assert page.get("/api/state").json()["picking"] == {}


@pytest.mark.parametrize(
    ("method", "path", "body", "status", "sentence"),
    [
        ("PUT", "", {"kind": "angle"}, 422, "kind"),
        ("PUT", "", {"kind": "length", "snap": "corner"}, 422, "snap"),
        ("POST", "/picks", {"origin_m": ABOVE, "direction": [0, 0, 1]}, 409, "picks nothing"),
        ("POST", "/end", None, 409, "picks nothing"),
        ("DELETE", "/picks/last", None, 409, "picks nothing"),
    ],
)
def test_what_cannot_be_picked_is_refused_with_a_sentence(
    page: httpx.Client, method: str, path: str, body: dict | None, status: int, sentence: str
) -> None:
    answer = page.request(method, PAGE + path, json=body)
    assert answer.status_code == status
    assert sentence in answer.json()["detail"]


def test_a_ray_without_direction_is_refused(page: httpx.Client) -> None:
    page.put(PAGE, json={"kind": "length"})
    answer = page.post(f"{PAGE}/picks", json={"origin_m": ABOVE, "direction": [0, 0, 0]})
    assert answer.status_code == 409
    assert "length above zero" in answer.json()["detail"]


def test_without_a_reference_there_is_nothing_to_compare(client: httpx.Client) -> None:
    answer = client.post("/api/reference/comparison")
    assert answer.status_code == 404
    assert "serve --reference FILE" in answer.json()["detail"]
    assert "reference" not in client.get("/api/state").json()
