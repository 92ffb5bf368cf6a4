// The values of a result as rows of a table, from result.json.
export type Verdict = "pass" | "fail" | "uncertain" | "invalid";

export interface ValueRow {
  measurement: string;
  name: string;            // of the value, without its unit
  value: number | null;
  unit: string;
  U: number | null;        // null = not known
  lower: number | null;    // null = no such limit
  upper: number | null;
  verdict: Verdict | null; // null = not judged
  reason: string;          // why there is no value; empty = there is one
}

type Keys = Record<string, unknown>;

const keysOf = (value: unknown): Keys => (typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Keys) : {});
const numberOf = (value: unknown): number | null => (typeof value === "number" && Number.isFinite(value) ? value : null);
const textOf = (value: unknown): string => (typeof value === "string" ? value : "");

export function verdictOf(word: unknown): Verdict | null {
  switch (word) {
    case "pass": case "ok": return "pass";
    case "fail": case "nok": return "fail";
    case "uncertain": return "uncertain";
    case "invalid": return "invalid";
    default: return null;
  }
}

function row(measurement: string, key: string, about: Keys, fallback: Keys): ValueRow {
  const limits = keysOf(about["limits"]);
  const unit = textOf(about["unit"]);
  return {
    measurement,
    name: key.replace(/_(um2?|deg|percent)$/, ""),
    value: numberOf(about["value"]),
    unit,
    U: numberOf(about["U"]),
    lower: numberOf(limits["lower"]),
    upper: numberOf(limits["upper"]),
    verdict: verdictOf(about["verdict"]),
    reason: numberOf(about["value"]) === null ? textOf(about["reason"]) || textOf(fallback["reason"]) : "",
  };
}

// Those that are judged come first, each group in the recipe's order.
export function rowsOf(result: unknown): ValueRow[] {
  const evaluation = keysOf(keysOf(result)["evaluation"]);
  const measurements = keysOf(evaluation["measurements"]);
  const order = Array.isArray(evaluation["order"]) ? evaluation["order"].map(String) : Object.keys(measurements);
  const rows: ValueRow[] = [];
  for (const name of order) {
    const measurement = keysOf(measurements[name]);
    const values = keysOf(measurement["values"]);
    const main = textOf(measurement["main_value"]);
    const keys = Object.keys(values).sort((a, b) => Number(b === main) - Number(a === main));
    for (const key of keys) rows.push(row(name, key, keysOf(values[key]), measurement));
    // Invalid as a whole, and nothing of it has limits: then it has no values, and what it lacks must not go unseen.
    const invalid = row(name, main, { verdict: measurement["verdict"] }, measurement);
    if (keys.length === 0 && (invalid.reason !== "" || invalid.verdict !== null)) rows.push(invalid);
  }
  // Figures of the map: all of them where the recipe has no evaluation, else those that have a verdict of their own.
  const isAlone = rows.length === 0;
  for (const [name, about] of Object.entries(keysOf(keysOf(result)["measurements"]))) {
    const figure = row("", name, keysOf(about), {});
    if (isAlone || figure.verdict !== null) rows.push(figure);
  }
  return [...rows.filter(({ verdict }) => verdict !== null), ...rows.filter(({ verdict }) => verdict === null)];
}

// Shares of the map are told in percent, with their limits.
export function forPeople(row: ValueRow): ValueRow {
  if (row.measurement !== "" || row.unit !== "1") return row;
  // 7 % is not 7.000000000000001 %.
  const percent = (share: number | null): number | null => (share === null ? null : Number((100 * share).toPrecision(12)));
  return { ...row, value: percent(row.value), U: percent(row.U), lower: percent(row.lower), upper: percent(row.upper), unit: "%" };
}

// Why most points of a map without heights are holes: the name of the reason, empty = not told.
export function mainHoleReason(result: unknown): string {
  const holes = Object.entries(keysOf(keysOf(keysOf(result)["values"])["hole_points"]));
  let found = "";
  let most = 0;
  for (const [name, count] of holes) {
    if (typeof count === "number" && count > most) [found, most] = [name, count];
  }
  return found;
}
