// Tables drawn from the data block. The digits follow reports/numbers.py.
const PRINTED_ROWS = 40;
const LONG = 30; // rows beyond which a table scrolls in a window of its own
const VERDICTS = ["verdict", "holds", "incremental", "delaunay", "premise", "bounds", "equal"];
const HUGE = 1e7; // from here on, decimals say nothing
const SPACE = "\u00a0"; // no line ends inside a number
const TIMES = `${SPACE}×${SPACE}`;
const GOOD = /^(agrees|close|plausible draw|yes|holds)$/;
const BAD = /^(differs|implausible draw|no)$/;

/** @param {number} power */
function superscript(power) {
  return "10" + String(power).replace(/[-0-9]/g, (c) => c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)]);
}

/** @param {number} log10 */
function powerOfTen(log10) {
  let power = Math.floor(log10);
  let mantissa = (10 ** (log10 - power)).toFixed(1);
  if (mantissa === "10.0") { mantissa = "1.0"; power += 1; }
  return mantissa + TIMES + superscript(power);
}

/** @param {string} text */
function signed(text) {
  if (!text.startsWith("-")) return text;
  return /[1-9]/.test(text) ? "−" + text.slice(1) : text.slice(1);
}

/**
 * @param {number} number
 * @param {number} digits
 */
function fixed(number, digits) {
  const [whole, rest] = number.toFixed(digits).split(".");
  const grouped = whole.replace(/\B(?=(\d{3})+(?!\d))/g, ",");
  return signed(rest === undefined ? grouped : `${grouped}.${rest}`);
}

/**
 * @param {number} number
 * @param {number} digits
 */
function significant(number, digits) {
  if (number === 0) return "0";
  const [mantissa, exponent] = number.toExponential(digits - 1).split("e");
  const power = Number(exponent);
  if (power >= -4 && power < 6) return fixed(number, Math.max(0, digits - 1 - power));
  return signed(mantissa) + TIMES + superscript(power);
}

/**
 * @param {Cell} value
 * @param {string} format
 */
function show(value, format) {
  if (value === null || Number.isNaN(value)) return "–";
  if (typeof value === "string") return value;
  if (!Number.isFinite(value)) return value < 0 ? "−∞" : "∞";
  const [, kind, digits] = format.match(/^(log10p|[a-z]+)(\d*)$/) ?? [];
  switch (kind) {
    case "int": return fixed(value, 0);
    case "fixed": return Math.abs(value) >= HUGE ? significant(value, 3) : fixed(value, Number(digits));
    case "percent": return fixed(100 * value, Number(digits)) + SPACE + "%";
    case "p":
      if (value === 0) return `<${SPACE}${superscript(-307)}`;
      return value >= 0.001 ? value.toFixed(4) : powerOfTen(Math.log10(value));
    case "log10p": return value >= -3 ? (10 ** value).toFixed(4) : powerOfTen(value);
    default: return significant(value, Number(digits));
  }
}

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

/**
 * A column of logarithms of p is shown as p, so that is its heading here.
 * @param {Column} column
 */
function headCell(column) {
  const label = column.format === "log10p" ? column.label.replace(/^log10 /, "") : column.label;
  const cell = element("th", { scope: "col", class: column.format === "text" ? "text" : "number" },
    label);
  if (column.unit && column.unit !== label.toLowerCase()) {
    cell.append(element("span", { class: "unit" }, column.unit));
  }
  return cell;
}

/**
 * @param {Cell} value
 * @param {Column} column
 * @param {boolean} first
 */
function bodyCell(value, column, first) {
  const name = column.name === "method" || column.name === "distribution";
  const text = name ? show(value, "text").replace("_", " ") : show(value, column.format);
  const cell = element(first ? "th" : "td", { class: column.format === "text" ? "text" : "number" });
  if (first) cell.setAttribute("scope", "row");
  if (text.length > 48) cell.classList.add("long");
  if (VERDICTS.includes(column.name)) {
    const sense = GOOD.test(text) ? "good" : BAD.test(text) ? "bad" : "";
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
  /** @type {[string, string][]} */
  const followed = (host.dataset.follows ?? "").split(" ").filter(Boolean).map((name) => [name, view[name]]);
  const where = { ...Object.fromEntries(followed), ...JSON.parse(host.dataset.where ?? "{}") };
  const rows = table.select(where);
  const wanted = host.dataset.columns ? host.dataset.columns.split(" ") : null;
  const constant = (/** @type {Column} */ { name }) => name in where
    || (name in view && choices[name].length === 1);
  const columns = table.columns.filter((column) =>
    !constant(column) && (!wanted || wanted.includes(column.name)));
  const places = columns.map((column) => table.place(column.name));

  const caption = host.dataset.caption ?? "";
  const body = element("tbody");
  const printed = "whole" in host.dataset ? rows.length : PRINTED_ROWS;
  rows.forEach((row, r) => {
    const line = element("tr", r < printed ? {} : { class: "beyond" });
    columns.forEach((column, k) => line.append(bodyCell(row[places[k]], column, k === 0)));
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
    said.push(`${fixed(rows.length, 0)} rows; a print-out has the first ${printed}.`);
  }
  foot.append(button, element("p", { class: "note" }, said.filter(Boolean).join(" ")));
  host.replaceChildren(scroll, foot);
}
