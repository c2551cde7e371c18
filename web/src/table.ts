// Tables: sortable columns, groups of rows, status chips, units with readable prefixes, CSV.
import { download, table_csv } from "./export";
import { h } from "./dom";
import { file_name, fixed, number, pick_scale, scientific, tied, with_unit, type Scale } from "./format";
import { colour_variable } from "./palette";
import type { Runs } from "./runs";
import type { Cell, Column, Row, Table } from "./types";

type Order = { key: string; down: boolean } | null;

interface Shown {
  column: Column;
  scale: Scale;
  format(value: number): string;
}

const DEFAULT_DIGITS = 4;

// Characters: longer texts take several lines.
const LONG = 40;

/** "failed", "failed (expected)", "completed", "overturned": class, mark and words of a status chip. */
function status_parts(text: string): { kind: string; mark: string; expected: boolean } {
  const expected = /expect/i.test(text) && !/unexpect/i.test(text);
  if (/overturn/i.test(text)) return { kind: "overturned", mark: "◣", expected };
  if (/fail|error|diverg|time|memory|crash|energy/i.test(text)) return { kind: "failed", mark: "✕", expected };
  if (/complete|ok|pass|sound|done/i.test(text)) return { kind: "completed", mark: "✓", expected };
  return { kind: "other", mark: "•", expected };
}

function status_chip(text: string): HTMLElement {
  const { kind, mark, expected } = status_parts(text);
  const word = expected ? text.replace(/[\s,(-]*\bexpected\b[\s)]*/i, "") || text : text;
  return h(
    "span",
    { class: `chip chip-${kind}${expected ? " chip-expected" : ""}`, title: expected ? "This outcome was expected" : null },
    h("span", { "aria-hidden": "true" }, mark),
    word,
    expected ? h("em", {}, "expected") : null,
  );
}

const is_number = (value: Cell): value is number => typeof value === "number" && Number.isFinite(value);

/** A line that tells when columns of a table lie beyond the right edge of its box. */
export function cut_note(box: HTMLElement): HTMLElement {
  const note = h("p", { class: "cut-note", hidden: true }, "Scroll sideways for the remaining columns.");
  new ResizeObserver(() => {
    const cut = box.scrollWidth > box.clientWidth + 1;
    box.classList.toggle("is-cut", cut);
    note.hidden = !cut;
  }).observe(box);
  return note;
}

export class TableCard {
  readonly element: HTMLElement;
  readonly table: Table;
  private readonly runs_: Runs;
  private readonly shown_: Shown[];
  private readonly body_ = h("tbody");
  private readonly box_ = h("div", { class: "table-box", tabindex: 0, role: "region" });
  private readonly heads_: HTMLTableCellElement[] = [];
  private order_: Order = null;

  constructor(table: Table, runs: Runs) {
    this.table = table;
    this.runs_ = runs;
    this.shown_ = table.columns.map((column) => this.prepare(column));
    this.element = this.build();
    this.fill();
  }

  get row_count(): number {
    return this.body_.querySelectorAll("tr:not(.group)").length;
  }

  private failed(row: Row): boolean {
    return this.table.columns.some((c) => c.kind === "status" && /fail|overturn/i.test(String(row[c.key] ?? "")));
  }

  /** Prefix and decimals from the sound rows, so that a blown-up run does not decide them. */
  private prepare(column: Column): Shown {
    const digits = column.digits ?? (column.kind === "percent" ? 3 : DEFAULT_DIGITS);
    const all = this.table.rows.map((row) => row[column.key]).filter(is_number);
    const sound = this.table.rows.filter((row) => !this.failed(row)).map((row) => row[column.key]).filter(is_number);
    const values = (sound.length > 0 ? sound : all).map(Math.abs).filter((v) => v > 0);
    const largest = Math.max(0, ...values);
    const smallest = values.length > 0 ? Math.min(...values) : 0;
    if (column.kind === "percent") {
      return { column, scale: { factor: 0.01, unit: "%" }, format: this.formatter(largest * 100, smallest * 100, digits, false) };
    }
    const scale = pick_scale(largest, column.unit);
    const whole = scale.unit === "" && all.every(Number.isInteger);
    return { column, scale, format: this.formatter(largest / scale.factor, smallest / scale.factor, digits, whole) };
  }

  /** One number of decimals for a column, unless its values span too many decades for that. */
  private formatter(largest: number, smallest: number, digits: number, whole: boolean): (value: number) => string {
    if (whole) return (v) => (Math.abs(v) >= 1e9 ? scientific(v, digits) : fixed(v, 0));
    const wide = smallest > 0 && largest / smallest > 2e4;
    if (wide || largest >= 1e6 || (largest > 0 && largest < 1e-4)) {
      return (v) => number(v, Math.min(digits, 3));
    }
    const decimals = largest > 0 ? Math.max(0, digits - 1 - Math.floor(Math.log10(largest))) : 0;
    return (v) => (Math.abs(v) > 20 * largest ? number(v, 3) : fixed(v, decimals));
  }

  private build(): HTMLElement {
    const { table } = this;
    const heads = this.shown_.map(({ column, scale }) => this.head(column, scale));
    const save = (): void => download(`${file_name(table.id)}.csv`, "text/csv", table_csv(table));
    this.box_.setAttribute("aria-label", table.title);
    this.box_.append(h("table", {}, h("thead", {}, h("tr", {}, ...heads)), this.body_));
    return h(
      "figure",
      { class: "card table-card", id: `table-${table.id}` },
      h("header", {}, h("h3", {}, table.title), h("div", { class: "tools" }, h("button", { type: "button", class: "tool-csv", onclick: save }, "CSV"))),
      this.box_,
      cut_note(this.box_),
      table.caption ? h("figcaption", {}, table.caption) : null,
    );
  }

  private head(column: Column, scale: Scale): HTMLTableCellElement {
    const unit = column.kind === "text" || column.kind === "status" ? "" : scale.unit;
    const button = h(
      "button",
      { type: "button", onclick: () => this.sort(column.key), title: `Sort by ${with_unit(column.label, unit)}` },
      h("span", {}, column.label),
      unit ? h("small", {}, unit) : null,
    );
    const cell = h("th", { scope: "col", class: `is-${column.kind}`, "aria-sort": "none" }, button);
    this.heads_.push(cell);
    return cell;
  }

  private sort(key: string): void {
    const now = this.order_;
    if (now?.key !== key) this.order_ = { key, down: false };
    else this.order_ = now.down ? null : { key, down: true };
    this.table.columns.forEach((column, i) => {
      const mine = this.order_?.key === column.key;
      this.heads_[i]?.setAttribute("aria-sort", mine ? (this.order_?.down ? "descending" : "ascending") : "none");
    });
    this.fill();
  }

  private sorted(rows: Row[]): Row[] {
    const order = this.order_;
    if (!order) return rows;
    const sign = order.down ? -1 : 1;
    return [...rows].sort((a, b) => {
      const [u, v] = [a[order.key], b[order.key]];
      // Missing values stay at the end in both directions.
      if (u === null || u === undefined) return 1;
      if (v === null || v === undefined) return -1;
      if (is_number(u) && is_number(v)) return sign * (u - v);
      return sign * String(u).localeCompare(String(v));
    });
  }

  private fill(): void {
    const { rows, rowGroup, columns } = this.table;
    this.body_.replaceChildren();
    const groups = rowGroup ? [...new Set(rows.map((row) => String(row[rowGroup] ?? "")))] : [null];
    for (const group of groups) {
      if (group !== null) {
        this.body_.append(h("tr", { class: "group" }, h("th", { colspan: columns.length, scope: "rowgroup" }, h("span", {}, group))));
      }
      const mine = group === null ? rows : rows.filter((row) => String(row[rowGroup ?? ""] ?? "") === group);
      for (const row of this.sorted(mine)) this.body_.append(this.row(row));
    }
  }

  private row(row: Row): HTMLElement {
    const cells = this.shown_.map((shown, i) => this.cell(row, shown, i === 0));
    return h("tr", { class: this.failed(row) ? "is-bad" : null }, ...cells);
  }

  private cell(row: Row, { column, scale, format }: Shown, first: boolean): HTMLElement {
    const value = row[column.key];
    const tag = first ? "th" : "td";
    const props = { class: `is-${column.kind}`, ...(first ? { scope: "row" } : {}) };
    if (value === null || value === undefined || value === "" || value === "-") return h(tag, { ...props, title: "No value" }, "–");
    if (column.kind === "status") return h(tag, props, status_chip(String(value)));
    if (is_number(value)) {
      const exact = `${value}${column.unit ? ` ${column.unit}` : ""}`;
      return h(tag, { ...props, title: exact }, format(value / scale.factor));
    }
    const text = String(value);
    if (text.length > LONG) props.class += " is-long";
    const known = this.runs_.names.includes(text);
    const dot = known ? h("i", { class: "dot", style: `background:${colour_variable(this.runs_.slot(text))}` }) : null;
    return h(tag, props, dot, tied(text));
  }
}
