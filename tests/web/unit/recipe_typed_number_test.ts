// What is typed into a number's input stands there after every key, whatever is drawn meanwhile.
import assert from "node:assert/strict";
import test from "node:test";
import type { VNode } from "preact";
import { drawn } from "./small_document.ts";

const { html } = await import("../../../daemon/web/src/lib/html.ts");
const { pairWith, shownText, valueOfText } = await import("../../../daemon/web/src/pages/recipe/fields/typed_number.ts");
const { NumberInput } = await import("../../../daemon/web/src/pages/recipe/fields/number_input.ts");
type Json = Parameters<typeof shownText>[1];

// The document keeps its values as text.
const kept = (value: Json): Json => (value === undefined ? undefined : JSON.parse(JSON.stringify(value)) as Json);

for (const whole of ["49.5", "-0.5", "0,005", "1e-3", "-", "abc", "1 000", "+3.10"]) {
  test(`"${whole}" stands as it is typed`, () => {
    for (let length = 1; length <= whole.length; ++length) {
      const typed = whole.slice(0, length);
      assert.equal(shownText(typed, kept(valueOfText(typed))), typed);
    }
  });
}

test("a value that came from elsewhere is shown in place of what was typed", () => {
  assert.equal(shownText("49.5", 12), "12");
  assert.equal(shownText("49.5", undefined), "");
  assert.equal(shownText("", 0), "0");
});

test("every key changes the document: nothing waits until the input is left", () => {
  let value: Json = 0.5;
  const editor = {
    get document() { return value === undefined ? {} : { upper: value }; },
    set: (_: unknown, next: Json) => { value = next; },
    remove: () => { value = undefined; },
  };
  const [input] = drawn(html`<${NumberInput} editor=${editor} path=${["upper"]} about=${{ "aria-label": "Upper" }}/>` as VNode).all("input");
  const key = [...(input?.listeners ?? [])].find(([name]) => name.toLowerCase() === "input")?.[1] ?? assert.fail("no listener");
  const type = (text: string): void => key.call(input, { type: "input", target: { value: text } });
  for (const [text, means] of [["", undefined], ["4", 4], ["49", 49], ["49.", 49], ["49.5", 49.5]] as const) {
    type(text);
    assert.equal(value, means, text);
  }
});

test("an emptied number of a pair keeps its place", () => {
  assert.deepEqual(pairWith([40, 80], 0, ""), ["", 80]);
  assert.deepEqual(pairWith(["", 80], 0, "5"), [5, 80]);
  assert.deepEqual(pairWith([40, 80], 1, ""), [40]);
  assert.deepEqual(pairWith(["", 80], 1, ""), []);
  assert.deepEqual(pairWith([], 0, "1"), [1]);
});
