"""Where the time of an edit goes, as the browser itself sees it: noted by scripts in the page."""

from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from typing import Any

from playwright.sync_api import Frame, Page

from core.benchmarks.measuring import percentile

BYTES_PER_VERTEX = 12
"""Of a mesh on its way; its faces go along only where they are others than before."""

WATCH = """(() => {
  const now = () => performance.timeOrigin + performance.now();
  Object.assign(window, { ups: [], saves: [], arrivals: [], draws: [] });
  addEventListener("pointerup", () => window.ups.push(now()), true);

  const { fetch } = window;
  window.fetch = async (path, options) => {
    const response = await fetch(path, options);
    if (options?.method === "PUT" && /\\/silhouette$/.test(path)) window.saves.push(now());
    return response;
  };

  const channel = new BroadcastChannel("arrivals");
  channel.onmessage = ({ data }) => window.arrivals.push(data);
  const LISTEN = `{
    const channel = new BroadcastChannel("arrivals");
    const Native = WebSocket;
    self.WebSocket = class extends Native {
      constructor(...given) {
        super(...given);
        this.addEventListener("message", ({ data }) => {
          const bytes = data.byteLength ?? data.size ?? 0;
          const ms = performance.timeOrigin + performance.now();
          if (bytes > 4000) channel.postMessage({ bytes, ms });
        });
      }
    };
  }`;
  const sourceOf = (address) => {
    const request = new XMLHttpRequest();
    request.open("GET", address, false);
    request.send();
    return request.responseText;
  };
  const NativeWorker = window.Worker;
  window.Worker = class extends NativeWorker {
    constructor(address, options) {
      const parts = [LISTEN, sourceOf(address)];
      super(URL.createObjectURL(new Blob(parts, { type: "text/javascript" })), options);
    }
  };

  const { prototype } = WebGL2RenderingContext;
  const { bufferData, drawElements, clear } = prototype;
  let freshMs = null;
  let pictures = 0;
  prototype.clear = function (...given) {
    pictures += 1;
    return clear.apply(this, given);
  };
  prototype.bufferData = function (target, data, ...rest) {
    if (data?.byteLength > 4000) freshMs ??= now();
    return bufferData.call(this, target, data, ...rest);
  };
  prototype.drawElements = function (mode, count, ...rest) {
    drawElements.call(this, mode, count, ...rest);
    if (freshMs === null || count < 300) return;
    const handedMs = freshMs;
    freshMs = null;
    this.readPixels(0, 0, 1, 1, this.RGBA, this.UNSIGNED_BYTE, new Uint8Array(4));
    window.draws.push({ faces: count / 3, handedMs, ms: now(), pictures });
  };
})()"""
"""Notes when the pointer was let go, when the page had the answer to what it saved, when a mesh had
come to the viewport's websocket, and when it was handed to WebGL and had been drawn.
WebGL's `finish` does not wait, so a pixel is read back."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stages:
    """What had happened so long after the pointer was let go, in ms.

    Attributes:
        published_ms: the server had the hull, counted from the edit's arrival at it.
        saved_ms: the page had the server's answer.
        received_ms: the viewport's websocket had the mesh.
        handed_ms: WebGL had begun to get it; before, pictures under way had to be finished.
        drawn_ms: it had been drawn, and a pixel read back.
    """

    published_ms: float
    saved_ms: float
    received_ms: float
    handed_ms: float
    drawn_ms: float


WORDS = {
    "published_ms": "server: edit in, hull out",
    "saved_ms": "save answered",
    "received_ms": "hull at the viewport's websocket",
    "handed_ms": "hull handed to WebGL",
    "drawn_ms": "hull drawn",
}

ON_THE_WAY = ("received_ms", "handed_ms", "drawn_ms")
"""Each follows the one before; the page's own answer comes beside them."""


def forget(space: Frame) -> None:
    """Forget what came to the viewport and what it drew so far."""
    space.evaluate("window.draws.length = window.arrivals.length = 0")


def stages(
    page: Page, space: Frame, up_ms: float, hull: dict[str, Any], published_ms: float
) -> Stages | None:
    """Wait until the hull of an edit is drawn, and return when what had happened.

    A hull that differs by less than single precision tells is not sent: then return None.

    Args:
        page: on which the edit was made.
        space: the viewport's frame in it.
        up_ms: when the pointer was let go.
        hull: what the server tells of the hull after the edit.
        published_ms: that the server says it took.
    """
    drawn = space.wait_for_function(
        "([faces, up]) => window.draws.find((draw) => draw.faces === faces && draw.ms >= up)",
        arg=[hull["faces"], up_ms],
    ).json_value()
    size = BYTES_PER_VERTEX * hull["vertices"]
    arrived_ms = space.evaluate(
        "([size, last]) => window.arrivals.findLast(({ bytes, ms }) => bytes >= size && ms <= last)"
        "?.ms",
        [size, drawn["handedMs"]],
    )
    if arrived_ms is None:
        return None
    saved_ms = page.evaluate("window.saves.at(-1)")
    return Stages(
        published_ms=published_ms,
        saved_ms=saved_ms - up_ms,
        received_ms=arrived_ms - up_ms,
        handed_ms=drawn["handedMs"] - up_ms,
        drawn_ms=drawn["ms"] - up_ms,
    )


def table(seen: Sequence[Stages]) -> str:
    """Return when each thing had happened after the pointer was let go, and how long steps took."""
    lines = [f"{'ms after pointer up':<34}{'p50':>6}{'p95':>6}   {'step p50':>8}{'step p95':>10}"]
    before = [0.0] * len(seen)
    for place, field in enumerate(fields(Stages)):
        at = [astuple(each)[place] for each in seen]
        line = f"{WORDS[field.name]:<34}{percentile(at, 50):>6.0f}{percentile(at, 95):>6.0f}"
        if field.name in ON_THE_WAY:
            steps = [now - then for now, then in zip(at, before, strict=True)]
            line += f"   {percentile(steps, 50):>8.0f}{percentile(steps, 95):>10.0f}"
            before = at
        lines.append(line)
    return "\n".join(lines)
