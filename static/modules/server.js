// Talking to the server: requests, and a link over which it tells of every change.

const FIRST_RETRY_MS = 500;
const LONGEST_RETRY_MS = 5000;

/** Fetch JSON; an error carries the server's own sentence. */
export async function getJson(path) {
  return (await answered(path)).json();
}

/** Send an order as JSON and return the new state. */
export async function order(path, body) {
  const response = await answered(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  });
  return response.json();
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
  const response = await fetch(path, options);
  if (response.ok) return response;
  const { detail } = await response.json().catch(() => ({}));
  throw new Error(detail ?? `The server answered ${response.status} to ${path}.`);
}

function littleEndian16(buffer) {
  const view = new DataView(buffer);
  const numbers = new Uint16Array(buffer.byteLength / 2);
  for (let place = 0; place < numbers.length; place += 1) {
    numbers[place] = view.getUint16(2 * place, true);
  }
  return numbers;
}
