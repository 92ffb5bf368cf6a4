// Numbers and units as people read them, on whichever page.
import assert from "node:assert/strict";
import test from "node:test";
import { digitsOf, digitsOfUncertain, usefulDigits } from "../../../daemon/web/src/lib/digits.ts";
import { shownUnit } from "../../../daemon/web/src/lib/units.ts";

test("digits that a reader can use", () => {
  assert.deepEqual([0, 3, 0.2251420737, 1994.656, 12.345, -12.345, NaN].map((value) => usefulDigits(value)), [0, 0, 4, 0, 2, 2, 0]);
  assert.equal(usefulDigits(9.9996, 4), 2, "9.9996 is 10.00 with four digits");
});

test("a value goes as far as the second digit of its uncertainty", () => {
  assert.deepEqual([0.0034, 0.4, 12, 0].map(digitsOfUncertain), [4, 2, 0, 0]);
  assert.equal(digitsOfUncertain(0.0996), 2, "0.0996 is 0.10 with two digits");
  assert.equal(digitsOfUncertain(0.999), 1, "0.999 is 1.0 with two digits");
});

test("decimals of what was measured follow from U, else from the value", () => {
  assert.deepEqual([0.0277, 1.2, 120].map((U) => digitsOf(49.978, U)), [3, 1, 0]);
  assert.deepEqual([undefined, null, 0].map((U) => digitsOf(49.978, U)), [3, 3, 3], "a U of zero tells nothing");
  assert.deepEqual([digitsOf(0, null), digitsOf(5, null)], [0, 0], "a count");
  assert.equal(digitsOf(0.000123, null), 6, "never more than six");
  assert.equal(digitsOf(1e-9, 1e-12), 6);
});

test("units are µm and °, powers stand above, and a pure number has none", () => {
  const written = ["um", "um2", "um^2", "um3/um2", "um^3/um^2", "um/mm", "px/um", "um/s", "us", "ms", "deg", "%", "percent", "1", "um/um", "N", "degree Celsius"];
  assert.deepEqual(written.map(shownUnit),
    ["µm", "µm²", "µm²", "µm³/µm²", "µm³/µm²", "µm/mm", "px/µm", "µm/s", "µs", "ms", "°", "%", "%", "", "", "N", "°C"]);
});
