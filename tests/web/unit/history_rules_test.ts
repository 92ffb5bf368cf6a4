import assert from "node:assert/strict";
import test from "node:test";
import { centreOf, marksOf } from "../../../daemon/web/src/history/control_rules.ts";
import { csvOf } from "../../../daemon/web/src/history/csv.ts";
import { addressOf, filterOf, wantedOf } from "../../../daemon/web/src/history/filter.ts";
import { pairs, valuesOf } from "../../../daemon/web/src/results/values.ts";

test("the centre: the mean, and sigma of the moving range", () => {
  assert.deepEqual(centreOf([1, null, 3, 1, 3]), { mean: 2, sigma: 2 / 1.128, count: 4 });
  assert.equal(centreOf([1, null]), null);
  assert.deepEqual(centreOf([2, 2, 2]), { mean: 2, sigma: 0, count: 3 });
});

test("rule 1 marks what is beyond three sigma, on either side, and not what is on it", () => {
  const centre = { mean: 10, sigma: 1, count: 20 };
  assert.deepEqual(marksOf([13, 13.01, 7, 6.99, null, NaN], centre).map((mark) => mark.rule1), [false, true, false, true, false, false]);
});

test("rule 4 marks from the eighth in a row on one side on", () => {
  const centre = { mean: 0, sigma: 10, count: 20 };
  const rule4 = (values: (number | null)[]) => marksOf(values, centre).map((mark) => mark.rule4);
  assert.deepEqual(rule4([1, 1, 1, 1, 1, 1, 1]).includes(true), false);
  assert.deepEqual(rule4([-1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1]), [false, false, false, false, false, false, false, false, true, true, false]);
  // A job without a value neither counts nor ends the row; a value on the mean ends it.
  assert.deepEqual(rule4([1, 1, 1, 1, null, 1, 1, 1, 1]).lastIndexOf(true), 8);
  assert.deepEqual(rule4([1, 1, 1, 1, 0, 1, 1, 1, 1]).includes(true), false);
  assert.deepEqual(marksOf([1, 2, 3], null), [{ rule1: false, rule4: false }, { rule1: false, rule4: false }, { rule1: false, rule4: false }]);
});

test("CSV: quotes, line ends, and numbers with a point", () => {
  assert.equal(csvOf(["a", "b"], [[1.5, 'say "x", y'], [null, "two\nlines"], [-1e-7, " x"]]), 'a,b\r\n1.5,"say ""x"", y"\r\n,"two\nlines"\r\n-1e-7," x"\r\n');
  assert.equal(csvOf(["a"], [[NaN], [Infinity]]), "a\r\n\r\n\r\n");
});

test("CSV: no text begins a formula, numbers stay numbers", () => {
  for (const text of ["=1+1", "+1", "-1", "@SUM(A1)", " =1", "\t=1", "\r=1", "\u0000=1", "\ufeff=1", "＝1", "|calc", "\tx"]) {
    const [, line] = csvOf(["a"], [[text]]).split(/\r\n/);
    assert.ok(line?.startsWith(`"'`), JSON.stringify(text));
  }
  assert.equal(csvOf(["a"], [[-1]]), "a\r\n-1\r\n");
  assert.equal(csvOf(["a"], [["part-1=x"]]), "a\r\npart-1=x\r\n");
});

test("the filter is in the address and comes back from it", () => {
  const wanted = { part: "A&B <x>", recipe: "groove", verdict: "fail", from: "2026-11-01", to: "2026-11-30", text: "=é" };
  assert.deepEqual(wantedOf(new URLSearchParams(addressOf(wanted).slice("/jobs?".length))), wanted);
  assert.equal(addressOf(wantedOf(new URLSearchParams(""))), "/jobs");
  assert.deepEqual(filterOf(wanted), {
    part_id: "A&B <x>", recipe: "groove", verdict: "fail", from_utc: "2026-11-01T00:00:00.000Z", to_utc: "2026-11-30T23:59:59.999Z", text: "=é",
  });
});

test("what the daemon would refuse of an address is left out, or cut", () => {
  const none = wantedOf(new URLSearchParams());
  assert.deepEqual(filterOf(none), {});
  assert.deepEqual(filterOf({ ...none, from: "soon", to: "2026-11", verdict: "ok", text: "  " }), {});
  assert.deepEqual(filterOf({ ...none, verdict: "none", text: " lost " }), { verdict: "none", text: "lost" });
  assert.equal(filterOf({ ...none, text: "x".repeat(1000) }).text?.length, 64);
  assert.equal(filterOf({ ...none, part: "p".repeat(65) }).part_id?.length, 64);
});

test("texts are cut by their bytes, between characters", () => {
  const none = wantedOf(new URLSearchParams());
  const bytes = (text = ""): number => new TextEncoder().encode(text).length;
  for (const character of ["ä", "€", "🔬"]) {
    for (let before = 0; before < 4; before += 1) {
      const typed = "x".repeat(before) + character.repeat(64);
      const filter = filterOf({ ...none, part: typed, recipe: typed, text: typed });
      for (const kept of [filter.part_id, filter.recipe, filter.text]) {
        assert.ok(bytes(kept) <= 64 && bytes(kept) > 64 - bytes(character), `${kept}`);
        assert.ok(typed.startsWith(kept ?? "-") && kept?.endsWith(character), `${kept}`);
      }
    }
  }
  assert.equal(filterOf({ ...none, text: "ä".repeat(32) }).text, "ä".repeat(32), "what fits is left alone");
});

test("days that the calendar has not are left out", () => {
  const none = wantedOf(new URLSearchParams());
  for (const day of ["2026-02-29", "2026-02-30", "2026-04-31", "2026-13-01", "2026-00-10", "2026-11-00", "2026-11-32", "2026-1-1", "", "x"]) {
    assert.deepEqual(filterOf({ ...none, from: day, to: day }), {}, day);
  }
  assert.deepEqual(filterOf({ ...none, from: "2028-02-29", to: "2026-12-31" }), {
    from_utc: "2028-02-29T00:00:00.000Z", to_utc: "2026-12-31T23:59:59.999Z",
  });
});

test("values of a result in the recipe's order, with what is missing", () => {
  const values = valuesOf({
    evaluation: {
      order: ["step", "land", "gone"],
      measurements: {
        land: { values: { Sa_um: { value: 1.5, unit: "um", U: 0.02 } } },
        step: { values: { height_um: { unit: "um", reason: "no groove", limits: { lower: 1 }, verdict: "invalid" } } },
      },
    },
  });
  assert.deepEqual(values.map(({ measurement, name, value, U, lower, upper, verdict, reason }) => [measurement, name, value, U, lower, upper, verdict, reason]), [
    ["step", "height_um", null, null, 1, null, "invalid", "no groove"],
    ["land", "Sa_um", 1.5, 0.02, null, null, null, ""],
  ]);
  assert.deepEqual(valuesOf(null), []);
  assert.equal(valuesOf({ measurements: { height_min: { value: 1, unit: "um" } } })[0]?.measurement, "map");
});

test("a measurement that failed as a whole says why", () => {
  const [value] = valuesOf({ evaluation: { measurements: { step: { main_value: "height_um", values: {}, reason: "too few points", verdict: "invalid" } } } });
  assert.deepEqual([value?.measurement, value?.name, value?.value, value?.reason, value?.verdict], ["step", "height_um", null, "too few points", "invalid"]);
});

test("values side by side, whichever of two results lacks one", () => {
  const value = (measurement: string, name: string) => ({ measurement, name, value: 1, unit: "", U: null, lower: null, upper: null, verdict: null, reason: "" });
  const found = pairs([value("a", "x"), value("b", "x")], [value("b", "x"), value("c", "x")]);
  assert.deepEqual(found.map((pair) => [pair.measurement, pair.before !== null, pair.after !== null]), [["b", true, true], ["c", false, true], ["a", true, false]]);
});
