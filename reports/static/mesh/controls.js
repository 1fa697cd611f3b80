// Pointer, wheel and keys on the drawing, and the buttons and the field below it.

const STILL = 4; // pixels: a hand is never quite still
/** @type {Record<string, [number, number]>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

class Controls {
  /**
   * @param {HTMLElement} host
   * @param {MeshPage} page
   */
  constructor(host, page) {
    this.page = page;
    this.stage = page.stage;
    /** Where each pointer that is down was last. @type {Map<number, [number, number]>} */
    this.pointers = new Map();
    this.moved = 0;
    this.wireStage();
    for (const button of host.querySelectorAll("button")) {
      button.addEventListener("click", () => page.act(button.dataset.do));
    }
    page.input.addEventListener("change", () => page.chooseNumber(page.input.value));
  }

  wireStage() {
    const { stage } = this;
    stage.addEventListener("pointerdown", (event) => this.press(event));
    stage.addEventListener("pointermove", (event) => this.move(event));
    stage.addEventListener("pointerup", (event) => this.release(event));
    stage.addEventListener("pointercancel", (event) => this.release(event));
    stage.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.metaKey) return; // a plain wheel scrolls the page
      event.preventDefault();
      this.page.zoom(Math.exp(-event.deltaY / 300), ...this.placeOf(event));
    }, { passive: false });
    stage.addEventListener("keydown", (event) => this.key(event));
  }

  /**
   * Where an event is on the stage.
   * @param {MouseEvent} event
   * @returns {[number, number]}
   */
  placeOf(event) {
    const box = this.stage.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** @param {PointerEvent} event */
  press(event) {
    const place = this.placeOf(event);
    this.stage.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, place);
    this.moved = 0;
    this.page.pick(...place);
  }

  /** @param {PointerEvent} event */
  move(event) {
    const before = this.pointers.get(event.pointerId);
    const [x, y] = this.placeOf(event);
    if (!before) {
      if (event.pointerType === "mouse" || event.pointerType === "pen") this.page.pick(x, y);
      return;
    }
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
    this.pointers.set(event.pointerId, [x, y]);
    const [dx, dy] = [x - before[0], y - before[1]];
    this.moved += Math.hypot(dx, dy);
    if (this.moved < STILL) return;
    this.stage.dataset.dragged = "";
    if (other) this.pinch(before, [x, y], other);
    else if (this.page.mesh.space && !event.shiftKey) this.page.turn(dx / 150, dy / 150, true);
    else this.page.zoom(1, before[0], before[1], x, y);
  }

  /**
   * One of two fingers moves, and the other stays.
   * @param {[number, number]} before
   * @param {[number, number]} now
   * @param {[number, number]} other
   */
  pinch(before, now, other) {
    const apart = Math.hypot(before[0] - other[0], before[1] - other[1]);
    const factor = Math.hypot(now[0] - other[0], now[1] - other[1]) / (apart || 1);
    this.page.zoom(factor, (before[0] + other[0]) / 2, (before[1] + other[1]) / 2,
      (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
  }

  /** @param {PointerEvent} event */
  release(event) {
    this.pointers.delete(event.pointerId);
    delete this.stage.dataset.dragged;
    this.page.rest();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { page, page: { mesh, chosen } } = this;
    const arrow = ARROWS[event.key];
    if (arrow && event.shiftKey && mesh.space) page.turn(arrow[0] * 0.15, arrow[1] * 0.15);
    else if (arrow) page.step(page.projection.toward(chosen, arrow));
    else if (event.key === "Home") page.step(0);
    else if (event.key === "End") page.step(mesh.m - 1);
    else if (event.key === "Enter" || event.key === " ") page.step(mesh.path(chosen).path[1]);
    else if (event.key === "+" || event.key === "=") page.act("in");
    else if (event.key === "-") page.act("out");
    else if (event.key === "0") page.act("whole");
    else return;
    event.preventDefault();
  }
}
