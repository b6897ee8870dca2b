// One line across the page for what went wrong, with what can be done about it.

export class Banner {
  #place;
  #text;
  #choices;
  #shown = "";

  constructor(place) {
    this.#place = place;
    this.#text = document.createElement("span");
    this.#choices = document.createElement("span");
    this.#choices.className = "choices";
    place.replaceChildren(this.#text, this.#choices);
  }

  /** Show a sentence and buttons [label, action]; an empty sentence hides the line. */
  show(sentence, choices = [], kind = "bad") {
    const wanted = JSON.stringify([sentence, kind, choices.map(([label]) => label)]);
    if (wanted === this.#shown) return;
    this.#shown = wanted;
    this.#place.dataset.kind = kind;
    this.#text.textContent = sentence;
    this.#choices.replaceChildren(
      ...choices.map(([label, action]) => {
        const button = document.createElement("button");
        button.type = "button";
        button.textContent = label;
        button.addEventListener("click", action);
        return button;
      }),
    );
    this.#place.hidden = sentence === "";
  }
}
