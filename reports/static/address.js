// The address of a view and of a place on the page: "#distribution=normal&section=theory", or
// "#theory" alone, which leaves the view as it is.

/**
 * The place that an address names, and what it says of the view; either may be missing.
 * @param {string} hash
 * @param {string[]} names of the switches
 */
function readAddress(hash, names) {
  const parameters = new URLSearchParams(hash.replace(/^#/, ""));
  /** @type {Record<string, string>} */
  const asked = {};
  let place = parameters.get("section");
  for (const [name, value] of parameters) {
    if (names.includes(name)) asked[name] = value;
    else if (value === "" && name !== "section") place ??= name;
  }
  return { asked, place };
}

/**
 * @param {Record<string, string>} view
 * @param {Record<string, string[]>} choices
 * @param {string} [place]
 */
function writeAddress(view, choices, place) {
  const parts = Object.entries(view).filter(([name]) => choices[name].length > 1)
    .map(([name, value]) => `${name}=${value}`);
  if (place) parts.push(parts.length ? `section=${place}` : place);
  return `#${parts.join("&")}`;
}
