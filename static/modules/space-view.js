// This page's own view in space: its layers, its camera, and a picture of it.

import { part } from "./elements.js";
import { getJson, send } from "./server.js";
import { askFor, hasWebGl, pictureOf } from "./space-picture.js";

/** What the browser calls this page, so that the server moves no other page's camera. */
const NAME = `page-${Date.now().toString(36)}-${Math.random().toString(36).slice(2, 12)}`;

export class SpaceView {
  /** Layers on show, by name; null until the server has told which there are. */
  #layers = null;
  #offered = [];
  #components = "";
  #state = null;
  #complain;
  #canDraw;
  #ready;

  /** Is called whenever other layers are on show. */
  onLayers = () => {};

  /** Load the view, and call `complain(sentence)` for what is refused. */
  constructor(complain) {
    this.#complain = complain;
    this.#canDraw = hasWebGl();
    if (this.#canDraw) part("viewport").src = `/viewport/${NAME}/`;
    else part("viewport").hidden = true;
    this.#watchKeyboard();
    part("space-picture").disabled = !this.#canDraw;
    part("space-picture").addEventListener("click", () => this.savePicture());
    this.#ready = this.#offer().catch((error) => complain(error.message));
  }

  /** What the server calls this page. */
  get name() {
    return NAME;
  }

  /** The layers on show, in the order of their buttons. */
  get layers() {
    return this.#offered.filter(({ name }) => this.#layers?.has(name)).map(({ name }) => name);
  }

  /** Show these layers and no others; unknown ones are left out and returned. */
  async setLayers(names) {
    await this.#ready;
    const known = new Set(this.#offered.map(({ name }) => name));
    this.#layers = new Set(names.filter((name) => known.has(name)));
    await this.#sendLayers();
    return names.filter((name) => !known.has(name));
  }

  /** Fetch where the camera stands, null before the view has connected. */
  async camera() {
    return (await getJson(`/api/viewport/${NAME}`)).camera;
  }

  setCamera(camera) {
    return send("PUT", `/api/viewport/${NAME}/camera`, camera);
  }

  update(state) {
    this.#state = state;
    if (!this.#canDraw) {
      part("space-empty").hidden = false;
      part("space-empty").textContent =
        "This browser draws no 3D (WebGL is off or missing); frames, editing and lengths work without it.";
    }
    const components = (state.components ?? []).map(({ label }) => label).join("/");
    if (components !== this.#components) {
      this.#components = components;
      this.#offer().catch((error) => this.#complain(error.message));
    }
  }

  /** Load the view again after the server was away, and tell it what this page shows. */
  reconnect() {
    // viser's client tries again only while its frame has the focus.
    if (this.#canDraw) part("viewport").contentWindow.location.reload();
    if (this.#layers !== null) this.#sendLayers();
  }

  /** Download what the view shows, as large as it is drawn. */
  async savePicture() {
    try {
      const canvas = largestCanvas(part("viewport").contentDocument);
      if (canvas === undefined) throw new Error("The 3D view is still loading; try again in a moment.");
      askFor(await pictureOf(canvas), this.#pictureName());
    } catch (error) {
      this.#complain(error.message);
    }
  }

  #pictureName() {
    const { source, shown, hull } = this.#state ?? {};
    const name = (source?.name ?? "").toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-");
    const parts = ["radarhull", name.replace(/^-|-$/g, ""), `frame${shown ?? 0}`];
    return [...parts.filter(Boolean), `rev${hull?.revision ?? 0}.png`].join("-");
  }

  async #offer() {
    const { layers, views, components } = await getJson("/api/viewport");
    this.#offered = layers;
    this.#layers ??= new Set(layers.filter(({ is_on: isOn }) => isOn).map(({ name }) => name));
    part("space-views").replaceChildren(...views.map((view) => this.#viewButton(view)));
    part("space-layers").replaceChildren(
      ...layers.map((layer) => this.#layerButton(layer)),
      ...(components.length > 1 ? components.map(componentEntry) : []),
    );
    this.#showPressed();
  }

  #viewButton({ name, hint }) {
    const button = document.createElement("button");
    button.type = "button";
    button.dataset.view = name;
    button.textContent = name.length > 2 ? name[0].toUpperCase() + name.slice(1) : name.replace("-", "−");
    button.title = hint;
    button.disabled = !this.#canDraw;
    button.addEventListener("click", () => {
      send("PUT", `/api/viewport/${NAME}/view`, { view: name })
        .catch((error) => this.#complain(error.message));
    });
    return button;
  }

  #layerButton({ name, title, hint, colour }) {
    const button = document.createElement("button");
    const swatch = document.createElement("i");
    button.type = "button";
    button.dataset.layer = name;
    button.title = hint;
    button.disabled = !this.#canDraw;
    swatch.className = `swatch layer-${name}`;
    swatch.style.setProperty("--swatch", colour);
    button.append(swatch, title);
    button.addEventListener("click", () => {
      if (!this.#layers.delete(name)) this.#layers.add(name);
      this.#sendLayers();
    });
    return button;
  }

  /** Put a layer on show, or take it off. */
  showLayer(name, isOn) {
    if (isOn) this.#layers?.add(name);
    else this.#layers?.delete(name);
    return this.#sendLayers();
  }

  async #sendLayers() {
    this.#showPressed();
    await send("PUT", `/api/viewport/${NAME}/layers`, { layers: this.layers })
      .catch((error) => this.#complain(error.message));
  }

  #showPressed() {
    this.onLayers();
    for (const button of part("space-layers").querySelectorAll("button")) {
      button.ariaPressed = String(this.#layers.has(button.dataset.layer));
    }
  }

  /** Say while the view in space has the keyboard, for its keys are others. */
  #watchKeyboard() {
    const frame = part("viewport");
    const show = (isThere) => { part("space-chip").hidden = !isThere; };
    frame.addEventListener("load", () => {
      frame.contentWindow.addEventListener("focus", () => show(true));
      frame.contentWindow.addEventListener("blur", () => show(false));
      show(document.activeElement === frame);
    });
    addEventListener("focus", () => show(false));
  }
}

/** viser draws in one canvas and marks selections in another, which is empty. */
function largestCanvas(document) {
  const canvases = [...document.querySelectorAll("canvas")].filter(({ width }) => width > 0);
  return canvases.sort((one, other) => other.width * other.height - one.width * one.height)[0];
}

function componentEntry({ label, colour }) {
  const entry = document.createElement("span");
  const swatch = document.createElement("i");
  entry.className = "component";
  entry.title = label === "target" ? "The whole hull, translucent so that its parts show" : "Hull of this part";
  swatch.className = "swatch";
  swatch.style.setProperty("--swatch", colour);
  entry.append(swatch, label === "target" ? "target (translucent)" : label);
  return entry;
}
