// Asking before something is lost. What has the focus, and what Escape means, is to leave it be.

/** Ask in a dialog; resolves with whether `action` was chosen. */
export function confirmed({ title, text, action }) {
  const dialog = document.createElement("dialog");
  dialog.className = "sheet confirm";
  dialog.setAttribute("aria-labelledby", "confirm-title");
  dialog.setAttribute("aria-describedby", "confirm-text");
  const heading = Object.assign(document.createElement("h2"), { id: "confirm-title", textContent: title });
  const words = Object.assign(document.createElement("p"), { id: "confirm-text", textContent: text });
  const cancel = Object.assign(document.createElement("button"), { textContent: "Cancel", value: "", autofocus: true });
  const go = Object.assign(document.createElement("button"), { textContent: action, value: "go", className: "danger" });
  const form = Object.assign(document.createElement("form"), { method: "dialog", className: "buttons" });
  form.append(cancel, go);
  dialog.append(heading, words, form);
  document.body.append(dialog);
  dialog.showModal();
  cancel.focus();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog.returnValue === "go");
    });
  });
}
