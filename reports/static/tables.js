// Tables drawn from the data block, whose cells come with the texts to show.
const PRINTED_ROWS = 40;
const LONG = 30; // rows beyond which a table scrolls in a window of its own

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

/** @param {Table} table */
function downloadCsv(table) {
  const link = element("a", { download: `${table.name}.csv` });
  link.href = URL.createObjectURL(new Blob([table.csv], { type: "text/csv" }));
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // a busy browser reads it late
}

/** @type {(column: Column) => string} */
const kindOf = (column) => column.number ? "number" : "text";

/** @param {Column} column */
function headCell(column) {
  const cell = element("th", { scope: "col", class: kindOf(column) }, column.label);
  if (column.unit) cell.append(element("span", { class: "unit" }, column.unit));
  return cell;
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
 * @param {HTMLElement} host
 * @param {ReportData} report
 * @param {Record<string, string>} view
 * @param {Record<string, string[]>} choices
 */
function drawTable(host, report, view, choices) {
  const table = report.table(host.dataset.table ?? "");
  const caption = host.dataset.caption ?? "";
  /** @type {[string, string][]} */
  const followed = (host.dataset.follows ?? "").split(" ").filter(Boolean).map((name) => [name, view[name]]);
  const where = { ...Object.fromEntries(followed), ...JSON.parse(host.dataset.where ?? "{}") };
  const rows = table.select(where);
  const wanted = host.dataset.columns ? host.dataset.columns.split(" ") : null;
  const constant = (/** @type {Column} */ { name }) => name in where
    || (name in view && choices[name].length === 1);
  const columns = table.columns.filter((column) =>
    !constant(column) && (!wanted || wanted.includes(column.name)));

  const body = element("tbody");
  const printed = "whole" in host.dataset ? rows.length : PRINTED_ROWS;
  rows.forEach((row, place) => {
    const line = element("tr", place < printed ? {} : { class: "beyond" });
    columns.forEach((column, k) =>
      line.append(bodyCell((column.shown ?? column.raw)[row], column, k === 0)));
    body.append(line);
  });
  const grid = element("table", {}, element("caption", {}, element("span", {}, caption)),
    element("thead", {}, element("tr", {}, ...columns.map(headCell))), body);
  const scroll = element("div", {
    class: rows.length > LONG ? "scroll long" : "scroll",
    role: "region",
    tabindex: "0",
    "aria-label": caption,
  }, grid);
  const button = element("button", { type: "button", class: "csv" }, "Download CSV");
  button.setAttribute("aria-label", `Download CSV of: ${caption}`);
  button.addEventListener("click", () => downloadCsv(table));
  const foot = element("div", { class: "foot" });
  const said = [table.note];
  if (!rows.length) said.push("No row could be computed for this choice.");
  if (rows.length > printed) {
    said.push(`${rows.length.toLocaleString("en")} rows; a print-out has the first ${printed}.`);
  }
  foot.append(button, element("p", { class: "note" }, said.filter(Boolean).join(" ")));
  host.replaceChildren(scroll, foot);
}
