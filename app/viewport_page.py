"""viser's client as the viewport of our page: its own build, under our rules."""

import base64
import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import viser
import zstandard

_ALPHABET = bytes(code for code in range(0x21, 0x7F) if chr(code) not in "\"&<>'`")
"""The 88 characters in which viser's build packs its client, four bytes in five of them."""

_LOADER = re.compile(
    r'<script data-p="(?P<packed>[^"]*)" data-ss="(?P<style_bytes>\d+)" '
    r'data-cs="(?P<code_bytes>\d+)">(?P<loader>.*?)</script>',
    re.DOTALL,
)

_STYLE = """<style>
[data-floating-window], [data-dock-leaf], .mantine-Notifications-root,
.mantine-Paper-root[style*="position: fixed"] { display: none !important; }
html, body { background: #0b0e14 !important; }
#root * { background-color: transparent !important; }
</style>"""
"""Hides viser's control panel, which a narrow window fixes to its foot, and its notices, whose
place our page takes, and shows our ground."""


_QUIET = """
addEventListener("unhandledrejection", (event) => {
  if (event.reason instanceof EvalError) event.preventDefault();
});
"""
"""Keeps quiet about viser's sorter of Gaussian splats: it wants eval, and no scene here has any."""

_PACE = """
const native = requestAnimationFrame.bind(window), cancel = cancelAnimationFrame.bind(window);
const waiting = new Map();
let drawn = 0, touched = 0, owed = 0, tickets = 0, passes = false;
window.Worker = class extends Worker {
  constructor(...given) {
    super(...given);
    this.addEventListener("message", () => { owed = 3; });
  }
};
for (const kind of ["pointerdown", "pointermove", "wheel", "keydown"]) {
  addEventListener(kind, (event) => {
    if (kind !== "pointermove" || event.buttons) touched = event.timeStamp;
  }, { capture: true, passive: true });
}
window.requestAnimationFrame = (callback) => {
  const ticket = ++tickets;
  const attempt = (now) => {
    const fresh = now - touched < 1500 || owed > 0;
    const due = now === drawn || fresh || now - drawn >= 120;
    if (!due) return waiting.set(ticket, native(attempt));
    waiting.delete(ticket);
    if (now !== drawn) {
      passes = owed === 3 && !passes;
      owed = Math.max(owed - 1, 0);
      drawn = now;
    }
    callback(now);
  };
  waiting.set(ticket, native(attempt));
  return ticket;
};
window.cancelAnimationFrame = (ticket) => {
  cancel(waiting.get(ticket));
  waiting.delete(ticket);
};
"""
"""Draws eight times a second unless somebody turns the view or the scene has just changed: viser
draws all the time, which without a graphics card takes a whole core from the reconstruction. Its
worker hands over what the server sends, and a hull that follows an edit is drawn at once: viser
takes it in before one picture and shows it in the next."""

_PLAIN = """
const { getContext } = HTMLCanvasElement.prototype;
let isSoftware;
const drawsBySoftware = () => {
  const context = getContext.call(document.createElement("canvas"), "webgl");
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  const name = names ? context.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
};
HTMLCanvasElement.prototype.getContext = function (kind, options) {
  if (!/^webgl/.test(kind)) return getContext.call(this, kind, options);
  isSoftware ??= drawsBySoftware();
  return getContext.call(this, kind, isSoftware ? { ...options, antialias: false } : options);
};
const { prototype } = WebGL2RenderingContext;
for (const name of Object.getOwnPropertyNames(prototype)) {
  if (!/^(clear|draw(Arrays|Elements|Range).*)$/.test(name)) continue;
  const draw = prototype[name];
  prototype[name] = function (...given) {
    if (!(passes && isSoftware)) draw.apply(this, given);
  };
}
"""
"""Without a graphics card leaves smooth edges away, which take as long as all the rest, and the
picture before which viser takes a change in: it would show the scene as it was."""

_SCRIPT = f"{_QUIET}(() => {{{_PACE}{_PLAIN}}})();"


@dataclass(frozen=True, slots=True)
class ViewportPage:
    """The page in the viewport's frame.

    Attributes:
        html: viser's client with its control panel hidden.
        content_security_policy: lets exactly this client run, and talk to its origin only.
    """

    html: str
    content_security_policy: str


def viewport_page() -> ViewportPage:
    """Return viser's client build, made ready to be served from our origin.

    Raises:
        RuntimeError: the build does not look like the pinned viser version's.
    """
    html = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text("utf-8")
    found = _LOADER.search(html)
    if found is None:
        raise RuntimeError(
            f"viser {viser.__version__} packs its client in a way this version of radarhull does "
            "not know; install the viser version that radarhull's pyproject.toml pins."
        )
    size = int(found["style_bytes"]) + int(found["code_bytes"])
    client = _unpacked(found["packed"].encode("ascii"), size)[int(found["style_bytes"]) :]
    scripts = [_SCRIPT.encode("utf-8"), found["loader"].encode("utf-8"), client]
    return ViewportPage(
        html=html.replace("<head>", f"<head><script>{_SCRIPT}</script>{_STYLE}", 1),
        content_security_policy=_policy([_hash_source(script) for script in scripts]),
    )


def _policy(scripts: list[str]) -> str:
    # The loader compiles zstd's WebAssembly and the client starts its worker from a blob.
    return "; ".join(
        [
            "default-src 'none'",
            f"script-src {' '.join(scripts)} 'wasm-unsafe-eval'",
            "worker-src blob: data:",
            "style-src 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "font-src data:",
            "connect-src 'self' data: blob:",
            "base-uri 'none'",
            "form-action 'none'",
            "frame-ancestors 'self'",
        ]
    )


def _hash_source(script: bytes) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(script).digest()).decode('ascii')}'"


def _unpacked(packed: bytes, size: int) -> bytes:
    """Return the `size` bytes of style and code that viser's loader would unpack."""
    digit = np.zeros(128, dtype=np.uint64)
    digit[np.frombuffer(_ALPHABET, dtype=np.uint8)] = np.arange(len(_ALPHABET), dtype=np.uint64)
    # A last group of r + 1 characters holds r bytes, from the least significant end.
    whole = len(packed) // 5 * 5
    groups = digit[np.frombuffer(packed[:whole], dtype=np.uint8)].reshape(-1, 5)
    value = groups @ (88 ** np.arange(4, -1, -1)).astype(np.uint64)
    rest = 0
    for code in packed[whole:]:
        rest = 88 * rest + int(digit[code])
    tail = rest.to_bytes(max(len(packed) - whole - 1, 0), "big")
    frame = value.astype(">u4").tobytes() + tail
    return zstandard.ZstdDecompressor().decompress(frame, max_output_size=size)
