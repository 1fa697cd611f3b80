// Terms explain themselves: by pointing, by touch, and by the keyboard. Without this script the
// browser opens a definition at a click, in the middle of the window.
const GAP = 8; // pixels between a term and its definition, and between that and the window's edge

/**
 * Where a box stands below its anchor, or above it where there is no room below.
 * @param {{ left: number, top: number, bottom: number }} anchor
 * @param {{ width: number, height: number }} box
 * @param {{ width: number, height: number }} room the window's
 */
function placeBeside(anchor, box, room) {
  const left = Math.max(GAP, Math.min(anchor.left, room.width - box.width - GAP));
  const below = anchor.bottom + GAP;
  const above = anchor.top - GAP - box.height;
  return { left, top: below + box.height + GAP > room.height && above >= 0 ? above : below };
}

/** Opens the definition of one term at a time. */
class Glossary {
  constructor() {
    /** @type {HTMLElement | null} */
    this.box = null;
    /** @type {HTMLElement | null} */
    this.term = null;
    this.leaving = 0;
    for (const term of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll(".term"))) this.wire(term);
    for (const box of document.querySelectorAll(".definition")) {
      box.addEventListener("pointerenter", () => clearTimeout(this.leaving));
      box.addEventListener("pointerleave", () => this.leave());
    }
    addEventListener("scroll", () => this.place(), { passive: true });
  }

  /** @param {HTMLElement} term */
  wire(term) {
    const box = document.getElementById(term.getAttribute("popovertarget") ?? "");
    if (!box) return;
    term.removeAttribute("popovertarget");
    const show = () => this.show(term, box);
    term.addEventListener("click", show);
    term.addEventListener("focus", show);
    term.addEventListener("blur", () => this.hide());
    term.addEventListener("pointerenter", (event) => { if (event.pointerType === "mouse") show(); });
    term.addEventListener("pointerleave", () => this.leave());
  }

  /**
   * @param {HTMLElement} term
   * @param {HTMLElement} box
   */
  show(term, box) {
    clearTimeout(this.leaving);
    if (this.box !== box) this.hide();
    this.box = box;
    this.term = term;
    if (!box.matches(":popover-open")) box.showPopover();
    this.place();
  }

  /** Put the definition beside its term, which may have moved with the page. */
  place() {
    if (!this.term || !this.box) return;
    const { left, top } = placeBeside(this.term.getBoundingClientRect(), this.box.getBoundingClientRect(),
      { width: document.documentElement.clientWidth, height: innerHeight });
    this.box.style.left = `${left}px`;
    this.box.style.top = `${top}px`;
  }

  /** Hide it soon, unless the pointer comes back or goes on to the definition. */
  leave() {
    this.leaving = window.setTimeout(() => this.hide(), 250);
  }

  hide() {
    if (this.box?.matches(":popover-open")) this.box.hidePopover();
    this.box = null;
  }
}
