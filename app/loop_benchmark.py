"""`radarhull bench loop`: from a pointer let go to the hull in a browser's hands.

A scripted session edits a running workstation through its own interface, HTTP and websocket, as a
page does. Edits are vertices dragged and outlines moved or scaled on frames drawn from the test
satellite's outlines.
"""

import http.client
import json
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from queue import SimpleQueue
from typing import Any

import cv2
import numpy as np
import viser
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from app.playback import Playback
from app.server import WorkstationServer, listening_socket, workstation
from app.source import Source
from app.stream import LiveStream
from core.analysis.analysis import Analysis
from core.arrays import Floats
from core.benchmarks.measuring import Progress, machine, percentile
from core.benchmarks.workload import GRID_SIDE_M, PIXEL_M, satellite_views
from core.experiments.results import Figure, Results
from core.frame import Frame
from core.hull.view import View
from core.reconstruction import ReconstructionSettings
from core.silhouettes.extraction import ExtractionSettings

SIZES = ((128, 60), (256, 60))
EDITS = 200
PREVIEWS = 60
WANTED_MS = {(128, 60): "<= 100 ms", (256, 60): "<= 250 ms"}
WANTED_HZ = ">= 10 Hz"
PATIENCE_S = 120.0


def run_loop(
    *,
    sizes: Sequence[tuple[int, int]] = SIZES,
    edits: int = EDITS,
    previews: int = PREVIEWS,
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Results:
    """Time a scripted session of edits, each from the request to the mesh at a viewport's client.

    Server and clients share this process, and the processor time is all of theirs.

    Args:
        sizes: (voxels a side, frames).
        edits: in each session.
        previews: in the drag at its end.
        seed: of frames and edits.
        progress: told of stage, steps done and steps in all.
    """
    before = machine()
    figures: list[Figure] = []
    for size, views in sizes:
        figures += _session(size, views, edits, previews, seed, progress)
    settings = {
        "sizes": [f"{size}x{views}" for size, views in sizes],
        "edits": edits,
        "previews": previews,
        "seed": seed,
        **before,
        "load_average_at_end": machine()["load_average"],
    }
    return Results(name="loop", settings=settings, figures=tuple(figures))


def drawn_frame(view: View, *, time_s: float, random: np.random.Generator) -> Frame:
    """Return a radar image of bright speckle within a view's outline, blurred, in noise."""
    shape = view.silhouette.image_shape
    speckle = view.silhouette.mask() * random.rayleigh(1.0, shape)
    body = cv2.GaussianBlur(speckle, (0, 0), 1.0)
    rows = view.projection.matrix[0, :3]
    return Frame(
        amplitude=np.hypot(body, random.rayleigh(0.004 * body.max(), shape)),
        projection=view.projection,
        time_s=time_s,
        sensor="radar",
        line_of_sight=rows / np.linalg.norm(rows),
        row_spacing_m=PIXEL_M,
        column_spacing_m=PIXEL_M,
        row_resolution_m=1.3 * PIXEL_M,
        column_resolution_m=1.3 * PIXEL_M,
        label=f"test satellite at {time_s:.0f} s",
    )


def satellite_source(views: int, seed: int) -> Source:
    """Return radar images of the test satellite, drawn from its outlines."""
    random = np.random.default_rng(seed)
    frames = [
        drawn_frame(view, time_s=float(number), random=random)
        for number, view in enumerate(satellite_views(views, seed=seed))
    ]
    return Source(name="test satellite", frames=lambda: frames, expected_frames=views)


def _session(
    size: int, views: int, edits: int, previews: int, seed: int, progress: Progress
) -> list[Figure]:
    settings = ReconstructionSettings(
        side_m=GRID_SIDE_M,
        spacing_m=GRID_SIDE_M / size,
        # Bright speckle over a tenth of an image would else be taken for its background.
        extraction=ExtractionSettings(censoring_factor=2.5),
    )
    whole_ms, published_ms, processor_ms = [], [], []
    with _running(satellite_source(views, seed), settings) as (port, stream):
        _wait_until_finished(stream)
        with _connected(port) as page, _Viewer(port, stream) as viewer:
            script = _edits(page, views, np.random.default_rng(seed))
            _edit(page, viewer, *next(script))  # compiles
            for done in range(1, edits + 1):
                number, order = next(script)
                start_s = time.process_time()
                whole_ms.append(_edit(page, viewer, number, order))
                processor_ms.append(1e3 * (time.process_time() - start_s))
                published_ms.append(stream.snapshot.latency_ms or 0.0)
                progress(f"{size}³×{views}", done, edits)
            rate_hz = _preview_rate_hz(page, viewer, previews, *next(script))
        is_same = _is_from_scratch(stream)
    title = f"{size}³×{views}"
    return [
        _figure(f"{title}: edit to viewport, median", percentile(whole_ms, 50), "ms"),
        _figure(
            f"{title}: edit to viewport, p95",
            percentile(whole_ms, 95),
            "ms",
            WANTED_MS.get((size, views)),
        ),
        _figure(f"{title}: edit to hull published, p95", percentile(published_ms, 95), "ms"),
        _figure(f"{title}: processor time of an edit, p95", percentile(processor_ms, 95), "ms"),
        _figure(f"{title}: previews shown in a drag", rate_hz, "Hz", WANTED_HZ),
        _figure(f"{title}: hulls that differ from scratch", float(not is_same), "", "<= 0"),
    ]


def _is_from_scratch(stream: LiveStream) -> bool:
    """Return whether the hull on show is, number by number, that of its outlines from scratch."""
    shown, fresh = stream.snapshot, Analysis(stream.snapshot.settings)
    for record in shown.records:
        fresh.receive(record.analysed.received, record.silhouette)
    assert shown.surface is not None
    return np.array_equal(shown.surface.vertices_m, fresh.surface.vertices_m) and np.array_equal(
        shown.surface.faces, fresh.surface.faces
    )


def _figure(name: str, value: float, unit: str, wanted: str | None = None) -> Figure:
    return Figure(name=name, value=value, unit=unit, wanted=wanted)


def _edit(
    page: http.client.HTTPConnection, viewer: "_Viewer", number: int, order: dict[str, Any]
) -> float:
    """Commit an outline and return the milliseconds until a viewport's client had the hull."""
    start_s = time.perf_counter()
    _asked(page, "PUT", f"/api/frames/{number}/silhouette", order)
    return 1e3 * (viewer.wait(start_s) - start_s)


def _preview_rate_hz(
    page: http.client.HTTPConnection,
    viewer: "_Viewer",
    previews: int,
    number: int,
    order: dict[str, Any],
) -> float:
    """Return how often a second the hull follows a drag that sends as soon as it is answered."""
    start_s = end_s = time.perf_counter()
    for step in range(previews):
        rings = [[[row + 0.1 * step, column] for row, column in ring] for ring in order["rings"]]
        sent_s = time.perf_counter()
        _asked(page, "PUT", f"/api/frames/{number}/preview", {**order, "rings": rings})
        end_s = viewer.wait(sent_s)
    _asked(page, "DELETE", f"/api/frames/{number}/preview")
    return previews / (end_s - start_s)


def _edits(
    page: http.client.HTTPConnection, views: int, random: np.random.Generator
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield endless (frame, order): four vertices dragged for one outline moved and scaled."""
    while True:
        number = int(random.integers(1, views + 1))
        outline = _asked(page, "GET", f"/api/frames/{number}")["silhouette"]
        rings = [np.array(ring) for ring in outline["rings"]]
        if random.random() < 0.8:
            ring = rings[int(random.integers(len(rings)))]
            ring[int(random.integers(len(ring)))] += random.normal(0.0, 2.0, 2)
        else:
            rings = _moved(rings, random)
        order = {"rings": [ring.tolist() for ring in rings], "claim": outline["claim"]}
        yield number, {**order, "tool": "script", "base_revision": outline["revision"]}


def _moved(rings: list[Floats], random: np.random.Generator) -> list[Floats]:
    centre = np.concatenate(rings).mean(axis=0)
    scale, shift = random.uniform(0.98, 1.02), random.normal(0.0, 1.0, 2)
    return [centre + scale * (ring - centre) + shift for ring in rings]


def _connected(port: int) -> closing[http.client.HTTPConnection]:
    return closing(http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S))


def _asked(
    page: http.client.HTTPConnection, method: str, path: str, body: Any = None
) -> dict[str, Any]:
    content = None if body is None else json.dumps(body)
    page.request(method, path, content, {"Content-Type": "application/json"})
    answer = page.getresponse()
    text = answer.read().decode()
    if answer.status != http.HTTPStatus.OK:
        raise RuntimeError(f"{method} {path} was answered {answer.status}: {text}")
    facts: dict[str, Any] = json.loads(text)
    return facts


class _Viewer:
    """A client of the viewport that notes when the mesh of the hull on show has come."""

    def __init__(self, port: int, stream: LiveStream) -> None:
        self._socket = connect(
            f"ws://127.0.0.1:{port}/viewport",
            subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
            max_size=None,
            compression=None,
        )
        self._stream = stream
        self._shown = stream.snapshot.surface
        self._messages: SimpleQueue[tuple[bytes, float]] = SimpleQueue()
        self._thread = threading.Thread(target=self._listen, daemon=True)

    def __enter__(self) -> "_Viewer":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()
        self._thread.join()

    def wait(self, start_s: float) -> float:
        """Wait for the hull on show, changed since `start_s`, and return when it had come.

        An edit that leaves the hull as it was sends no mesh and counts until now.
        """
        before, self._shown = self._shown, self._stream.snapshot.surface
        assert before is not None
        assert self._shown is not None
        # The viewport's vertices are of single precision.
        shown, earlier = (mesh.vertices_m.astype(np.float32) for mesh in (self._shown, before))
        if np.array_equal(shown, earlier):
            return time.perf_counter()
        vertices = shown.tobytes()
        deadline_s = time.perf_counter() + PATIENCE_S
        while True:
            message, came_s = self._messages.get(timeout=deadline_s - time.perf_counter())
            if came_s > start_s and vertices in message:
                return came_s

    def _listen(self) -> None:
        try:
            for message in self._socket:
                assert isinstance(message, bytes)
                self._messages.put((message, time.perf_counter()))
        except ConnectionClosed:
            return


@contextmanager
def _running(source: Source, settings: ReconstructionSettings) -> Iterator[tuple[int, LiveStream]]:
    """Serve `source` on a free port, and give the port and the live loop."""
    ready = threading.Event()
    with (
        listening_socket("127.0.0.1", 0) as listener,
        workstation(source, settings, playback=Playback(speed_hz=None)) as app,
    ):
        server = WorkstationServer(app, ready.set)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
        thread.start()
        try:
            if not ready.wait(PATIENCE_S):
                raise RuntimeError("The server did not start.")
            yield listener.getsockname()[1], app.state.stream
        finally:
            server.should_exit = True
            thread.join(PATIENCE_S)


def _wait_until_finished(stream: LiveStream) -> None:
    deadline_s = time.monotonic() + PATIENCE_S
    while stream.snapshot.status != "finished":
        if time.monotonic() > deadline_s or stream.snapshot.status == "failed":
            raise RuntimeError(f"The frames were not received: {stream.snapshot.message}")
        time.sleep(0.02)
