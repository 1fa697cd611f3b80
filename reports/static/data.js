// The data block: tables, cell by cell as files have them and as they are shown, and figures as
// Plotly specifications that refer to them.

/** @typedef {string | number | null} Cell */

/**
 * A column of a table: its cells as the CSV file has them, and as they are shown where that differs.
 * @typedef {object} Column
 * @property {string} name
 * @property {string} header of the CSV file
 * @property {string} label
 * @property {string} [unit]
 * @property {string} [note] beside the table's own
 * @property {boolean} [number]
 * @property {boolean} [verdict]
 * @property {Record<string, string>} [senses] of verdicts: "good" or "bad"
 * @property {string[]} raw
 * @property {string[]} [shown]
 */

/** @typedef {{ title: string, note: string, columns: Column[] }} TableSpec */

/**
 * A figure of each view, by the view's name; "*" is for all.
 * @typedef {Record<string, object>} FigureSpecs
 */

/** @type {(cell: string) => string} */
const quoted = (cell) => /[",\r\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell;

class Table {
  /**
   * @param {string} name
   * @param {TableSpec} spec
   */
  constructor(name, { title, note, columns }) {
    this.name = name;
    this.title = title;
    this.note = note;
    this.columns = columns;
    this.byName = new Map(columns.map((column) => [column.name, column]));
    this.length = columns[0].raw.length;
  }

  /** @param {string} name */
  has(name) {
    return this.byName.has(name);
  }

  /** @param {string} name */
  get(name) {
    const column = this.byName.get(name);
    if (!column) throw new Error(`table ${this.name} has no column ${name}`);
    return column;
  }

  /**
   * Places of the rows whose columns have the values asked for.
   * @param {Record<string, unknown>} where
   */
  select(where = {}) {
    const wanted = Object.entries(where)
      .map(([name, value]) => ({ raw: this.get(name).raw, text: String(value) }));
    return [...Array(this.length).keys()].filter((row) =>
      wanted.every(({ raw, text }) => raw[row] === text));
  }

  /**
   * Values of a column: words as they are, numbers as doubles, null for an empty cell.
   * @param {string} name
   * @param {number[]} rows
   * @returns {Cell[]}
   */
  values(name, rows) {
    const { raw, number } = this.get(name);
    return rows.map((row) => raw[row] === "" ? null : number ? Number(raw[row]) : raw[row]);
  }

  get csv() {
    return this.csvOf(this.columns, this.select());
  }

  /**
   * @param {Column[]} columns
   * @param {number[]} rows
   */
  csvOf(columns, rows) {
    const lines = [columns.map((column) => column.header),
      ...rows.map((row) => columns.map((column) => column.raw[row]))];
    return lines.map((line) => line.map(quoted).join(",") + "\n").join("");
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
      const rows = this.table(table).select(where);
      return this.table(table).values(column, rows);
    }
    return Object.fromEntries(Object.entries(node).map(([key, item]) => [key, this.resolve(item)]));
  }
}
