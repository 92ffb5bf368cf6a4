// Numbers as typed, and as shown.
import assert from "node:assert/strict";
import test from "node:test";
import { typedNumber } from "../../../daemon/web/src/pages/setup/typed_number.ts";
import { digitsOfUncertain, shownUnit, usefulDigits } from "../../../daemon/web/src/pages/setup/units.ts";
import { figureText } from "../../../daemon/web/src/pages/setup/studies/figure_text.ts";

test("comma and point are decimal signs", () => {
  assert.equal(typedNumber("1,5"), 1.5);
  assert.equal(typedNumber(" 1.5 "), 1.5);
  assert.equal(typedNumber("-,5"), -0.5);
  assert.equal(typedNumber("−2"), -2);
  assert.equal(typedNumber("3."), 3);
  assert.equal(typedNumber("1e-3"), 0.001);
});

test("what is no number is none", () => {
  for (const text of ["", " ", ".", "1,5,5", "1.000,5", "0x10", "Infinity", "NaN", "1 2", "1e999", "--1", "5 µm"]) {
    assert.equal(typedNumber(text), null, JSON.stringify(text));
  }
});

test("digits that a reader can use", () => {
  assert.equal(usefulDigits(0), 0);
  assert.equal(usefulDigits(3), 0);
  assert.equal(usefulDigits(0.2251420737), 4);
  assert.equal(usefulDigits(1994.656), 0);
  assert.equal(usefulDigits(12.345), 2);
  assert.equal(usefulDigits(NaN), 0);
});

test("a value goes as far as the second digit of its uncertainty", () => {
  assert.equal(digitsOfUncertain(0.0034), 4);
  assert.equal(digitsOfUncertain(0.4), 2);
  assert.equal(digitsOfUncertain(12), 0);
  assert.equal(digitsOfUncertain(0), 0);
});

test("units for people", () => {
  assert.equal(shownUnit("um"), "µm");
  assert.equal(shownUnit("um/mm"), "µm/mm");
  assert.equal(shownUnit("1"), "");
  assert.equal(shownUnit("px"), "px");
});

const told = (value: number, digits: number): string => value.toFixed(digits);

test("figures with, without uncertainty, and without a value", () => {
  const noise = { name: "noise_um", value: 0.2251420737, unit: "um", U: 0.0034, k: 2, reason: "" };
  assert.deepEqual(figureText(noise, told), { value: "0.2251", uncertainty: "± 0.0034 (k = 2)", unit: "µm" });
  assert.deepEqual(figureText({ name: "scans", value: 3, unit: "1", reason: "" }, told), { value: "3", uncertainty: "", unit: "" });
  assert.deepEqual(figureText({ name: "Cg", value: null, unit: "1", reason: "no spread" }, told), { value: "–", uncertainty: "", unit: "" });
});
