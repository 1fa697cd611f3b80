// The theme after the first paint: the button that switches it, and paper, which is always light.

const prefersDark = matchMedia("(prefers-color-scheme: dark)");

/** @returns {boolean} whether the page is dark now, by the reader's choice or the system's */
function isDark() {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : prefersDark.matches;
}

/** @param {string} [theme] "light" or "dark"; the system's if left out */
function setTheme(theme) {
  if (theme) document.documentElement.dataset.theme = theme;
  else delete document.documentElement.dataset.theme;
}

/**
 * Let the button switch the theme; it says the theme that it switches to.
 * @param {() => void} repaint draws anew what the style sheet does not reach
 */
function wireTheme(repaint) {
  const button = /** @type {HTMLButtonElement} */ (document.getElementById("theme"));
  const word = /** @type {HTMLElement} */ (button.querySelector("span"));
  const nameNext = () => { word.textContent = isDark() ? "Light" : "Dark"; };
  button.addEventListener("click", () => {
    const theme = isDark() ? "light" : "dark";
    setTheme(theme);
    try { localStorage.setItem("theme", theme); } catch { /* kept for this visit only */ }
    nameNext();
    repaint();
  });
  prefersDark.addEventListener("change", () => {
    nameNext();
    repaint();
  });
  nameNext();
}

/**
 * Print in the light theme, and go back to the reader's.
 * @param {() => void} prepare called before printing, when the page is light
 * @param {() => void} restore called after printing, when the page is as it was
 */
function printInLight(prepare, restore) {
  /** @type {string | undefined} */
  let theme;
  addEventListener("beforeprint", () => {
    theme = document.documentElement.dataset.theme;
    setTheme("light");
    prepare();
  });
  addEventListener("afterprint", () => {
    setTheme(theme);
    restore();
  });
}
