// Tables drawn from the data block, whose cells come with the texts to show; sorted and filtered.
const PRINTED_ROWS = 40;
const LONG = 30; // rows beyond which a table scrolls in a window of its own
const MANY = 12; // rows beyond which a table has a filter

/**
 * What a reader has asked of a table, kept while the rows change.
 * @typedef {{ column: string | null, descending: boolean, filter: string }} Arrangement
 */

/** @type {WeakMap<HTMLElement, Arrangement>} */
const arrangements = new WeakMap();

/**
 * @template {keyof HTMLElementTagNameMap} Name
 * @param {Name} name
 * @param {Record<string, string>} attributes
 * @param {...(Node | string)} children
 */
function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/**
 * Rows in the order of a column: numbers by value, words by the alphabet, empty cells last. Rows
 * that are equal there stay in the order they have.
 * @param {number[]} rows
 * @param {Column} column
 * @param {boolean} descending
 */
function sorted(rows, { raw, number }, descending) {
  const sign = descending ? -1 : 1;
  const words = new Intl.Collator("en", { numeric: true });
  return [...rows].sort((a, b) => {
    const [x, y] = [raw[a], raw[b]];
    if (x === "" || y === "") return Number(x === "") - Number(y === "");
    return sign * (number ? numberOf(x) - numberOf(y) || 0 : words.compare(x, y));
  });
}

/** @param {string} text of a number in a CSV file */
function numberOf(text) {
  if (text === "inf") return Infinity;
  return text === "-inf" ? -Infinity : Number(text);
}

/**
 * Text as one types it: no capitals, plain spaces and minus signs.
 * @param {string} text
 */
const typed = (text) => text.toLowerCase().replaceAll("\u00a0", " ").replaceAll("−", "-");

/**
 * Rows in whose cells, as they are shown, every word of the filter occurs.
 * @param {number[]} rows
 * @param {Column[]} columns
 * @param {string} filter
 */
function matching(rows, columns, filter) {
  const words = typed(filter).split(" ").filter(Boolean);
  if (!words.length) return rows;
  return rows.filter((row) => {
    const text = typed(columns.map((column) => (column.shown ?? column.raw)[row]).join("\n"));
    return words.every((word) => text.includes(word));
  });
}

/**
 * What a click on a column's heading asks for: ascending, then descending, then as it was.
 * @param {Arrangement} arrangement
 * @param {string} column
 * @returns {Arrangement}
 */
function clicked(arrangement, column) {
  if (arrangement.column !== column) return { ...arrangement, column, descending: false };
  if (!arrangement.descending) return { ...arrangement, descending: true };
  return { ...arrangement, column: null, descending: false };
}

/** @type {(column: Column) => string} */
const kindOf = (column) => column.number ? "number" : "text";

/** @param {Column} column */
function headCell(column) {
  const button = element("button", { type: "button", title: "Sort by this column" }, column.label);
  if (column.unit) button.append(element("span", { class: "unit" }, column.unit));
  return element("th", { scope: "col", class: kindOf(column), "data-column": column.name }, button);
}

/**
 * @param {string} text
 * @param {Column} column
 * @param {boolean} first
 */
function bodyCell(text, column, first) {
  const cell = element(first ? "th" : "td", { class: kindOf(column) });
  if (first) cell.setAttribute("scope", "row");
  if (text.length > 48) cell.classList.add("long");
  if (column.verdict) {
    const sense = column.senses?.[text] ?? "";
    cell.append(element("span", { class: "verdict", "data-sense": sense }, text));
  } else cell.append(text);
  return cell;
}

/**
 * Say at which sides a table goes on beyond its window; only then can the keyboard scroll it.
 * @param {HTMLElement} scroll
 */
function markClipped(scroll) {
  const { scrollLeft, scrollTop, scrollWidth, scrollHeight, clientWidth, clientHeight } = scroll;
  const sides = Object.entries({
    left: scrollLeft > 1,
    right: scrollLeft + clientWidth < scrollWidth - 1,
    bottom: scrollTop + clientHeight < scrollHeight - 1,
  }).filter(([, beyond]) => beyond).map(([side]) => side);
  /** @type {HTMLElement} */ (scroll.parentElement).dataset.clipped = sides.join(" ");
  if (scrollWidth > clientWidth + 1 || scrollHeight > clientHeight + 1) scroll.setAttribute("tabindex", "0");
  else scroll.removeAttribute("tabindex");
}

/**
 * The switches that pick the rows of a table, with what they are set to.
 * @param {HTMLElement} host
 * @param {Record<string, string>} view
 * @returns {[string, string][]}
 */
const followedBy = (host, view) =>
  (host.dataset.follows ?? "").split(" ").filter(Boolean).map((name) => [name, view[name]]);

/**
 * What a view asks of the rows of a table.
 * @param {HTMLElement} host
 * @param {Record<string, string>} view
 * @returns {Record<string, any>}
 */
const whereOf = (host, view) =>
  ({ ...Object.fromEntries(followedBy(host, view)), ...JSON.parse(host.dataset.where ?? "{}") });

/**
 * The columns that a table shows, and the rows that the view picks.
 * @param {HTMLElement} host
 * @param {Table} table
 * @param {Record<string, string>} view
 * @param {Record<string, string[]>} choices
 */
function picked(host, table, view, choices) {
  const where = whereOf(host, view);
  const constant = (/** @type {Column} */ { name }) => name in where
    || (name in view && choices[name].length === 1);
  const wanted = host.dataset.columns ? host.dataset.columns.split(" ").map((name) => table.get(name)) : table.columns;
  return { rows: table.select(where), columns: wanted.filter((column) => !constant(column)) };
}

/** @param {HTMLElement} host */
function captionOf(host) {
  const { caption = "", paper, address = "" } = host.dataset;
  const text = element("p", { class: "caption" }, caption);
  if (paper) text.append(element("small", {}, ` the paper’s ${paper}`));
  text.append(element("a", { class: "anchor", href: `#${address}`, "aria-label": `Link to the table: ${caption}` }));
  return text;
}

/**
 * @param {HTMLElement} host
 * @param {ReportData} report
 * @param {Record<string, string>} view
 * @param {Record<string, string[]>} choices
 */
function drawTable(host, report, view, choices) {
  const table = report.table(host.dataset.table ?? "");
  const caption = host.dataset.caption ?? "";
  const { rows: all, columns } = picked(host, table, view, choices);
  const printed = "whole" in host.dataset ? all.length : PRINTED_ROWS;
  let arrangement = arrangements.get(host) ?? { column: null, descending: false, filter: "" };
  let rows = all;

  const body = element("tbody");
  const heads = columns.map(headCell);
  const grid = element("table", { "aria-label": caption },
    element("thead", {}, element("tr", {}, ...heads)), body);
  const scroll = element("div", {
    class: all.length > LONG ? "scroll long" : "scroll",
    role: "region",
    "aria-label": caption,
  }, grid);
  const state = element("span", { class: "state", role: "status" });

  const fill = () => {
    arrangements.set(host, arrangement);
    rows = matching(all, columns, arrangement.filter);
    const by = arrangement.column;
    if (by) rows = sorted(rows, table.get(by), arrangement.descending);
    for (const cell of heads) {
      const here = cell.dataset.column === by;
      cell.setAttribute("aria-sort", !here ? "none" : arrangement.descending ? "descending" : "ascending");
    }
    body.replaceChildren(...rows.map((row, place) => element("tr", place < printed ? {} : { class: "beyond" },
      ...columns.map((column, k) => bodyCell((column.shown ?? column.raw)[row], column, k === 0)))));
    state.textContent = arrangement.filter ? `${rows.length} of ${all.length} rows` : "";
    markClipped(scroll);
  };

  grid.tHead?.addEventListener("click", (event) => {
    const cell = /** @type {Element} */ (event.target).closest("th");
    if (!cell?.dataset.column) return;
    arrangement = clicked(arrangement, cell.dataset.column);
    fill();
  });
  scroll.addEventListener("scroll", () => markClipped(scroll), { passive: true });

  const head = element("div", { class: "head" }, captionOf(host));
  if (all.length > MANY) {
    const field = element("input", { type: "search", placeholder: "Filter rows", "aria-label": `Filter: ${caption}` });
    field.value = arrangement.filter;
    field.addEventListener("input", () => {
      arrangement = { ...arrangement, filter: field.value };
      fill();
    });
    head.append(element("div", { class: "tools" }, field, state));
  }
  const offer = (/** @type {string} */ name, /** @type {string} */ kind, /** @type {() => void} */ act) => {
    const button = element("button", { type: "button", class: kind, "aria-label": `${name}: ${caption}` }, name);
    button.addEventListener("click", act);
    return button;
  };
  const foot = element("div", { class: "foot" },
    offer("Download CSV", "csv", () => saveCsv(`${table.name}.csv`, table.csv)),
    offer("CSV of what is shown", "csv-shown", () =>
      saveCsv(`${table.name}_shown.csv`, table.csvOf(columns, rows))));
  const said = [...new Set([table.note, ...columns.map((column) => column.note)])];
  if (!all.length) said.push("No row could be computed for this choice.");
  if (all.length > printed) {
    said.push(`${all.length.toLocaleString("en")} rows; a print-out has the first ${printed}.`);
  }
  foot.append(element("p", { class: "note" }, said.filter(Boolean).join(" ")));
  host.replaceChildren(head, element("div", { class: "window" }, scroll), foot);
  fill();
  new ResizeObserver(() => markClipped(scroll)).observe(scroll);
}
