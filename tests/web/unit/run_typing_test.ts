// What can be typed into keeps the focus; whatever else has it gives it up for the part's field.
import assert from "node:assert/strict";
import { test } from "node:test";
import { takesKeys, takesText } from "../../../daemon/web/src/run/typing.ts";

test("text goes into fields, and into nothing else", () => {
  for (const type of ["text", "password", "search", "number", "date"]) assert.equal(takesText({ localName: "input", type }), true, type);
  for (const type of ["checkbox", "radio", "button", "range", "file"]) assert.equal(takesText({ localName: "input", type }), false, type);
  assert.equal(takesText({ localName: "textarea" }), true);
  assert.equal(takesText({ localName: "div", isContentEditable: true }), true);
  for (const localName of ["body", "a", "button", "select", "main"]) assert.equal(takesText({ localName }), false, localName);
  assert.equal(takesText(null), false);
});

test("letters choose in a list, which keeps the focus as well", () => {
  assert.equal(takesKeys({ localName: "select" }), true);
  assert.equal(takesKeys({ localName: "input", type: "text" }), true);
  assert.equal(takesKeys({ localName: "button" }), false);
  assert.equal(takesKeys(null), false);
});
