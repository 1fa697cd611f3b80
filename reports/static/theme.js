// Runs before the first paint: a theme that the reader chose earlier holds from the start.
try {
  const chosen = localStorage.getItem("theme");
  if (chosen) document.documentElement.dataset.theme = chosen;
} catch { /* a browser may keep no storage for files */ }
