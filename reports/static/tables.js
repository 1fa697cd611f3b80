// Tables drawn from the data block, whose cells come with the texts to show.
const PRINTED_ROWS = 40;
const LONG = 30; // rows beyond which a table scrolls in a window of its own

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function downloadCsv(table) {
  const link = element("a", { download: `${table.name}.csv` });
  link.href = URL.createObjectURL(new Blob([table.csv], { type: "text/csv" }));
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // a busy browser reads it late
}

const kindOf = (column) => column.number ? "number" : "text";

function headCell({ label, unit, ...column }) {
  const cell = element("th", { scope: "col", class: kindOf(column) }, label);
  if (unit) cell.append(element("span", { class: "unit" }, unit));
  return cell;
}

function bodyCell(text, column, first) {
  const cell = element(first ? "th" : "td", { class: kindOf(column) });
  if (first) cell.scope = "row";
  if (text.length > 48) cell.classList.add("long");
  if (column.verdict) {
    const sense = column.senses[text] ?? "";
    cell.append(element("span", { class: "verdict", "data-sense": sense }, text));
  } else cell.append(text);
  return cell;
}

function drawTable(host, report, view, choices) {
  const table = report.table(host.dataset.table);
  const followed = host.dataset.follows.split(" ").filter(Boolean).map((name) => [name, view[name]]);
  const where = { ...Object.fromEntries(followed), ...JSON.parse(host.dataset.where ?? "{}") };
  const rows = table.select(where);
  const wanted = host.dataset.columns ? host.dataset.columns.split(" ") : null;
  const constant = ({ name }) => name in where
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
  const grid = element("table", {}, element("caption", {}, element("span", {}, host.dataset.caption)),
    element("thead", {}, element("tr", {}, ...columns.map(headCell))), body);
  const scroll = element("div",
    { class: rows.length > LONG ? "scroll long" : "scroll", role: "region", tabindex: "0", "aria-label": host.dataset.caption }, grid);
  const button = element("button", { type: "button", class: "csv" }, "Download CSV");
  button.setAttribute("aria-label", `Download CSV of: ${host.dataset.caption}`);
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
