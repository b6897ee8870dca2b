// Menus that open under their buttons, wherever these are.

/** Let a popover open under the right edge of its button. */
export function openUnder(menu, button) {
  menu.addEventListener("beforetoggle", ({ newState }) => {
    if (newState !== "open") return;
    const { bottom, right } = button.getBoundingClientRect();
    menu.style.inset = `${bottom + 6}px ${Math.max(8, innerWidth - right)}px auto auto`;
  });
}
