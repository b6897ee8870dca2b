// Talking to the server: requests, and a link over which it tells of every change.

import { rounded } from "./rings.js";

const FIRST_RETRY_MS = 500;
const LONGEST_RETRY_MS = 5000;

/** Fetch JSON; an error carries the server's own sentence, and its status. */
export async function getJson(path) {
  return (await answered(path)).json();
}

/** Where the server has a frame, with the outline of one component. */
export function framePath(number, component, what = "") {
  const query = component === "target" ? "" : `?component=${encodeURIComponent(component)}`;
  return `/api/frames/${number}${what}${query}`;
}

/** Send JSON by a method and return the answer. */
export async function send(method, path, body) {
  const response = await answered(path, {
    method,
    headers: { "Content-Type": "application/json" },
    body: body === undefined ? undefined : JSON.stringify(body),
  });
  return response.json();
}

/** Send a file; `tell(sent, total)` follows it. Gives the answer as `done`, and `cancel()`. */
export function upload(path, file, tell) {
  // fetch does not tell how much of a body has gone.
  const request = new XMLHttpRequest();
  request.open("POST", path);
  request.setRequestHeader("Content-Type", "application/octet-stream");
  request.responseType = "json";
  request.upload.addEventListener("progress", ({ loaded, total }) => tell(loaded, total));
  const done = new Promise((resolve, reject) => {
    request.addEventListener("load", () => {
      if (request.status < 400) resolve(request.response);
      else reject(new Error(request.response?.detail ?? `The server answered ${request.status} to ${path}.`));
    });
    request.addEventListener("error", () => reject(new Error("The server does not answer; is it still running?")));
    request.addEventListener("abort", () => reject(new DOMException("given up", "AbortError")));
  });
  request.send(file);
  return { done, cancel: () => request.abort() };
}

/** Ask what a tool would make of a component's outline in a frame; changes nothing. */
export function propose(number, component, tool, parameters, rings) {
  const body = { tool, component, parameters, rings: rings.length > 0 ? rounded(rings) : null };
  return send("POST", `/api/frames/${number}/proposals`, body);
}

/** Fetch a frame's levels: 16-bit numbers and what they mean in dB. */
export async function getLevels(number) {
  const response = await answered(`/api/frames/${number}/image`);
  const header = (name) => Number(response.headers.get(name));
  return {
    rows: header("X-Rows"),
    columns: header("X-Columns"),
    floorDb: header("X-Floor-dB"),
    stepDb: header("X-Step-dB"),
    numbers: littleEndian16(await response.arrayBuffer()),
  };
}

/** Call `onState` with every state and `onLink` with "connected" or "lost"; reconnects by itself. */
export function keepLinked(onState, onLink) {
  let retryMs = FIRST_RETRY_MS;
  const connect = () => {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/api/live`);
    socket.onopen = () => {
      retryMs = FIRST_RETRY_MS;
      onLink("connected");
    };
    socket.onmessage = (event) => onState(JSON.parse(event.data));
    socket.onclose = () => {
      onLink("lost");
      setTimeout(connect, retryMs);
      retryMs = Math.min(2 * retryMs, LONGEST_RETRY_MS);
    };
  };
  connect();
}

async function answered(path, options) {
  const response = await fetch(path, options).catch(() => {
    throw new Error("The server does not answer; is it still running?");
  });
  if (response.ok) return response;
  const { detail } = await response.json().catch(() => ({}));
  const error = new Error(detail ?? `The server answered ${response.status} to ${path}.`);
  throw Object.assign(error, { status: response.status });
}

function littleEndian16(buffer) {
  const view = new DataView(buffer);
  const numbers = new Uint16Array(buffer.byteLength / 2);
  for (let place = 0; place < numbers.length; place += 1) {
    numbers[place] = view.getUint16(2 * place, true);
  }
  return numbers;
}
