// The data block: tables as CSV text, figures as Plotly specifications that refer to them.
/** @typedef {string | number | null} Cell */

/**
 * @typedef {object} Column
 * @property {string} name
 * @property {string} label
 * @property {string} [unit]
 * @property {string} format
 */

/**
 * A table as the data block has it.
 * @typedef {object} TableSpec
 * @property {string} title
 * @property {string} note
 * @property {Column[]} columns
 * @property {string} csv
 */

/**
 * A figure of each view, by the view's name; "*" is for all.
 * @typedef {Record<string, object>} FigureSpecs
 */

/** @param {string} text */
function parseCsv(text) {
  const rows = [];
  /** @type {string[]} */
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
  /**
   * @param {string} name
   * @param {TableSpec} spec
   */
  constructor(name, { title, note, columns, csv }) {
    this.name = name;
    this.title = title;
    this.note = note;
    this.columns = columns;
    this.csv = csv;
    /** @type {Map<string, number>} */
    this.index = new Map(columns.map((column, k) => [column.name, k]));
  }

  /**
   * Rows of cells: text as it is, numbers as doubles, null for an empty cell.
   * @type {Cell[][]}
   */
  get rows() {
    const numeric = this.columns.map((column) => column.format !== "text");
    const read = (/** @type {string} */ cell, /** @type {number} */ k) =>
      cell === "" ? null : numeric[k] ? Number(cell) : cell;
    const rows = parseCsv(this.csv).slice(1).map((row) => row.map(read));
    Object.defineProperty(this, "rows", { value: rows });
    return rows;
  }

  /** @param {string} name */
  place(name) {
    const k = this.index.get(name);
    if (k === undefined) throw new Error(`table ${this.name} has no column ${name}`);
    return k;
  }

  /** @param {Record<string, unknown>} where */
  select(where) {
    const wanted = Object.entries(where).filter(([name]) => this.index.has(name));
    return this.rows.filter((row) =>
      wanted.every(([name, value]) => String(row[this.place(name)]) === String(value)));
  }

  /**
   * @param {string} name
   * @param {Record<string, unknown>} [where]
   */
  column(name, where = {}) {
    const k = this.place(name);
    return this.select(where).map((row) => row[k]);
  }
}

class ReportData {
  /** @param {{ tables: Record<string, TableSpec>, figures: Record<string, FigureSpecs> }} data */
  constructor({ tables, figures }) {
    this.tables = new Map(
      Object.entries(tables).map(([name, table]) => [name, new Table(name, table)]));
    this.figures = figures;
  }

  /** @param {string} name */
  table(name) {
    const table = this.tables.get(name);
    if (!table) throw new Error(`there is no table ${name}`);
    return table;
  }

  /**
   * Put the columns of tables where a figure refers to them.
   * @param {any} node of JSON
   * @returns {any}
   */
  resolve(node) {
    if (Array.isArray(node)) return node.map((item) => this.resolve(item));
    if (node === null || typeof node !== "object") return node;
    if (node.$) {
      const [table, column, where] = node.$;
      return this.table(table).column(column, where);
    }
    return Object.fromEntries(Object.entries(node).map(([key, item]) => [key, this.resolve(item)]));
  }
}
