// In which frames this page edited, so that undoing finds its way back to them.

export class EditTrail {
  #done = { undo: [], redo: [] };

  /** Remember an "edit", "undo" or "redo" of a frame. */
  note(what, number) {
    const { undo, redo } = this.#done;
    if (what === "edit") this.#done.redo = redo.filter((other) => other !== number);
    else if (what === "undo") redo.push(...takenOut(undo, number));
    if (what === "redo") takenOut(redo, number);
    if (what !== "undo") undo.push(number);
  }

  /** The last other frame in which there was something to undo or to redo, or null. */
  elsewhere(direction, number) {
    return this.#done[direction].findLast((other) => other !== number) ?? null;
  }
}

/** Take a frame's last mention out, and return it. */
function takenOut(numbers, number) {
  const last = numbers.lastIndexOf(number);
  return last < 0 ? [] : numbers.splice(last, 1);
}
