// Figures of studies as they are shown.
import assert from "node:assert/strict";
import test from "node:test";
import { figureText } from "../../../daemon/web/src/pages/setup/studies/figure_text.ts";

const told = (value: number, digits: number): string => value.toFixed(digits);

test("figures with, without uncertainty, and without a value", () => {
  const noise = { name: "noise_um", value: 0.2251420737, unit: "um", U: 0.0034, k: 2, reason: "" };
  assert.deepEqual(figureText(noise, told), { value: "0.2251", uncertainty: "± 0.0034 (k = 2)", unit: "µm" });
  assert.deepEqual(figureText({ name: "scans", value: 3, unit: "1", reason: "" }, told), { value: "3", uncertainty: "", unit: "" });
  assert.deepEqual(figureText({ name: "Cg", value: null, unit: "1", reason: "no spread" }, told), { value: "–", uncertainty: "", unit: "" });
});
