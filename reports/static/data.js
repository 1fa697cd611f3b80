// The data block: tables as CSV text, figures as Plotly specifications that refer to them.
function parseCsv(text) {
  const rows = [];
  let row = [];
  let cell = "";
  let quoted = false;
  for (let k = 0; k < text.length; k++) {
    const character = text[k];
    if (quoted) {
      if (character !== '"') cell += character;
      else if (text[k + 1] === '"') { cell += '"'; k++; }
      else quoted = false;
    } else if (character === '"') quoted = true;
    else if (character === ",") { row.push(cell); cell = ""; }
    else if (character === "\n") { row.push(cell); rows.push(row); row = []; cell = ""; }
    else cell += character;
  }
  return rows;
}

class Table {
  constructor(name, { title, note, columns, csv }) {
    Object.assign(this, { name, title, note, columns, csv });
    this.index = new Map(columns.map((column, k) => [column.name, k]));
  }

  // Rows of cells: text as it is, numbers as doubles, null for an empty cell.
  get rows() {
    const numeric = this.columns.map((column) => column.format !== "text");
    const read = (cell, k) => cell === "" ? null : numeric[k] ? Number(cell) : cell;
    const rows = parseCsv(this.csv).slice(1).map((row) => row.map(read));
    Object.defineProperty(this, "rows", { value: rows });
    return rows;
  }

  select(where) {
    const wanted = Object.entries(where).filter(([name]) => this.index.has(name))
      .map(([name, value]) => [this.index.get(name), value]);
    return this.rows.filter((row) => wanted.every(([k, value]) => String(row[k]) === String(value)));
  }

  column(name, where = {}) {
    const k = this.index.get(name);
    return this.select(where).map((row) => row[k]);
  }
}

class Report {
  constructor({ tables, figures }) {
    this.tables = new Map(
      Object.entries(tables).map(([name, table]) => [name, new Table(name, table)]));
    this.figures = figures;
  }

  // Put the columns of tables where a figure refers to them.
  resolve(node) {
    if (Array.isArray(node)) return node.map((item) => this.resolve(item));
    if (node === null || typeof node !== "object") return node;
    if (node.$) {
      const [table, column, where] = node.$;
      return this.tables.get(table).column(column, where);
    }
    return Object.fromEntries(Object.entries(node).map(([key, item]) => [key, this.resolve(item)]));
  }
}
