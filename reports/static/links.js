// Places of the page: going to them, staying there while the page fills, and copying their address.

/** Keeps a place at the top of the window until the reader moves. */
class Landing {
  constructor() {
    /** @type {HTMLElement | null} */
    this.target = null;
    for (const name of ["wheel", "touchmove", "keydown", "pointerdown"]) {
      addEventListener(name, () => { this.target = null; }, { passive: true });
    }
    new ResizeObserver(() => this.target?.scrollIntoView({ behavior: "instant" }))
      .observe(/** @type {Element} */ (document.getElementById("main")));
  }

  /** @param {string | null} place id of an element */
  go(place) {
    const target = place ? document.getElementById(place) : null;
    this.target = target;
    if (!target) return;
    for (let fold = target.closest("details"); fold; fold = fold.parentElement?.closest("details") ?? null) {
      fold.open = true;
    }
    target.scrollIntoView({ behavior: "instant" });
    const heading = /** @type {HTMLElement} */ (target.matches("h3") ? target
      : target.querySelector("h2, h4, summary, .caption") ?? target);
    if (heading.tabIndex < 0) heading.setAttribute("tabindex", "-1");
    heading.focus({ preventScroll: true });
  }
}

/**
 * Copy a text and say so beside the element that was clicked.
 * @param {HTMLElement} by
 * @param {string} text
 */
async function copy(by, text) {
  try {
    await navigator.clipboard.writeText(text);
    by.dataset.copied = "copied";
  } catch {
    by.dataset.copied = "in the address bar";
    if (by.matches("button")) by.dataset.copied = "select and copy";
  }
  announce(by.dataset.copied);
  setTimeout(() => delete by.dataset.copied, 2000);
}

/** @param {string} text for who does not see the page */
function announce(text) {
  /** @type {HTMLElement} */ (document.getElementById("announcement")).textContent = text;
}

/** Let the boxes of text be copied. */
function wireCopying() {
  for (const button of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("button.copy"))) {
    button.hidden = false;
    button.addEventListener("click", () =>
      copy(button, button.parentElement?.querySelector("pre")?.textContent ?? ""));
  }
}

/** Fold the parts of each section away in the contents, and unfold those of the section that is read. */
function wireContents() {
  const links = [.../** @type {NodeListOf<HTMLAnchorElement>} */ (
    document.querySelectorAll(".contents > ol > li > a"))];
  for (const button of document.querySelectorAll(".unfold")) {
    button.addEventListener("click", () =>
      unfold(button, button.getAttribute("aria-expanded") === "false"));
  }
  const wide = matchMedia("(min-width: 62rem)");
  const reading = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      for (const link of links) {
        const here = link.hash === `#${target.id}`;
        if (here) link.setAttribute("aria-current", "true");
        else link.removeAttribute("aria-current");
        const button = link.parentElement?.querySelector(".unfold");
        if (button && wide.matches) unfold(button, here);
      }
    }
  }, { rootMargin: "-20% 0px -75% 0px" });
  document.querySelectorAll("main > section").forEach((section) => reading.observe(section));
}

/**
 * @param {Element} button
 * @param {boolean} open
 */
function unfold(button, open) {
  button.setAttribute("aria-expanded", String(open));
}
