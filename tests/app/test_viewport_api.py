import httpx
import pytest

from app.layers import FIRST_LAYERS

CAMERA = {
    "position": [40.0, 1.0, -3.0],
    "look_at": [0.5, 0.0, 0.0],
    "up": [0.0, 0.0, -1.0],
    "field_of_view_deg": 20.0,
}


def test_the_page_is_told_what_it_can_choose(client: httpx.Client) -> None:
    choices = client.get("/api/viewport").json()
    names = [layer["name"] for layer in choices["layers"]]
    expected = "hull wireframe picture outline key-points sights grid uncarved measurements"
    assert names == expected.split()
    assert {layer["name"] for layer in choices["layers"] if layer["is_on"]} == FIRST_LAYERS
    assert all(layer["hint"] and layer["colour"][0] == "#" for layer in choices["layers"])
    assert choices["components"] == [{"label": "target", "colour": "#a8b8cc"}]
    assert [view["name"] for view in choices["views"]][:3] == ["home", "+x", "-x"]


def test_layers_and_camera_are_kept_for_each_page(client: httpx.Client) -> None:
    assert client.get("/api/viewport/one").json() == {
        "layers": sorted(FIRST_LAYERS),
        "camera": None,
    }
    answer = client.put("/api/viewport/one/layers", json={"layers": ["grid", "hull"]})
    assert answer.json()["layers"] == ["grid", "hull"]
    camera = client.put("/api/viewport/one/camera", json=CAMERA).json()
    assert {**camera, "field_of_view_deg": round(camera["field_of_view_deg"], 9)} == CAMERA
    assert client.get("/api/viewport/one").json()["camera"] == camera
    assert client.get("/api/viewport/two").json()["camera"] is None


@pytest.mark.parametrize("view", ["home", "-z", "sight", "plane"])
def test_named_views_look_at_the_target(client: httpx.Client, view: str) -> None:
    camera = client.put("/api/viewport/three/view", json={"view": view}).json()
    assert camera["look_at"] == [0, 0, 0]
    assert client.get("/api/viewport/three").json()["camera"] == camera


@pytest.mark.parametrize(
    ("path", "body", "status", "sentence"),
    [
        ("one/layers", {"layers": ["clouds"]}, 422, "There is no layer clouds"),
        ("one/view", {"view": "up"}, 404, "There is no view 'up'; the views are home, +x"),
        ("one/camera", {**CAMERA, "position": CAMERA["look_at"]}, 422, "must look somewhere"),
        ("one/camera", {**CAMERA, "position": [1, 2]}, 422, "position"),
        ("one/camera", {**CAMERA, "field_of_view_deg": 0}, 422, "field of view"),
        ("o_e/layers", {"layers": []}, 422, "name"),
        ("x" * 65 + "/layers", {"layers": []}, 422, "name"),
    ],
)
def test_what_makes_no_view_is_refused_with_a_sentence(
    client: httpx.Client, path: str, body: dict, status: int, sentence: str
) -> None:
    answer = client.put(f"/api/viewport/{path}", json=body)
    assert answer.status_code == status
    assert sentence in answer.json()["detail"]


def test_a_named_view_is_the_same_client_at_another_address(client: httpx.Client) -> None:
    plain, named = client.get("/viewport/"), client.get("/viewport/page-1/")
    assert named.text == plain.text
    policy = "Content-Security-Policy"
    assert named.headers[policy] == plain.headers[policy]
