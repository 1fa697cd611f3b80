// The data block: tables, cell by cell as files have them and as they are shown, and figures as
// Plotly specifications that refer to them.
"use strict";

// Bytes of base64 text; a loop is ten times as fast as Uint8Array.from with a function.
function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; k++) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

function inflate(id) {
  const bytes = bytesOf(document.getElementById(id).textContent);
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")));
}

// Run an inflated script; from a blob the browser compiles it beside the page, not in its way.
async function runInflated(id) {
  const address = URL.createObjectURL(await inflate(id).blob());
  const script = document.createElement("script");
  script.src = address;
  await new Promise((resolve, reject) => {
    script.onload = resolve;
    script.onerror = () => reject(new Error(`cannot run ${id}`));
    document.head.append(script);
  });
  URL.revokeObjectURL(address);
}

const quoted = (cell) => /[",\r\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell;

class Table {
  // A column has the texts of its cells: `raw` as in the CSV file, `shown` where that differs.
  constructor(name, { title, note, columns }) {
    Object.assign(this, { name, title, note, columns });
    this.byName = new Map(columns.map((column) => [column.name, column]));
    this.length = columns[0].raw.length;
  }

  has(name) {
    return this.byName.has(name);
  }

  get(name) {
    const column = this.byName.get(name);
    if (!column) throw new Error(`table ${this.name} has no column ${name}`);
    return column;
  }

  // Places of the rows whose columns have the values asked for.
  select(where = {}) {
    const wanted = Object.entries(where).map(([name, value]) => [this.get(name).raw, String(value)]);
    return [...Array(this.length).keys()].filter((row) =>
      wanted.every(([raw, value]) => raw[row] === value));
  }

  // Values of a column: words as they are, numbers as doubles, null for an empty cell.
  values(name, rows) {
    const { raw, number } = this.get(name);
    return rows.map((row) => raw[row] === "" ? null : number ? Number(raw[row]) : raw[row]);
  }

  get csv() {
    const lines = [this.columns.map((column) => column.header),
      ...this.select().map((row) => this.columns.map((column) => column.raw[row]))];
    return lines.map((line) => line.map(quoted).join(",") + "\n").join("");
  }
}

class Report {
  constructor({ tables, figures }) {
    this.tables = new Map(
      Object.entries(tables).map(([name, table]) => [name, new Table(name, table)]));
    this.figures = figures;
  }

  table(name) {
    const table = this.tables.get(name);
    if (!table) throw new Error(`there is no table ${name}`);
    return table;
  }

  // Put the columns of tables where a figure refers to them.
  resolve(node) {
    if (Array.isArray(node)) return node.map((item) => this.resolve(item));
    if (node === null || typeof node !== "object") return node;
    if (node.$) {
      const [table, column, where] = node.$;
      const rows = this.table(table).select(where);
      return this.table(table).values(column, rows);
    }
    return Object.fromEntries(Object.entries(node).map(([key, item]) => [key, this.resolve(item)]));
  }
}
