// Recipes with one thing or two wrong, or not wrong at all: the same for the same seed.
import { whole } from "./random.mjs";

const kValues = [-1, 0, 0.5, 3, 1e9, 1e-9, "7", "", null, true, [], {}, [1, 2, 3], "no_such_word"];

// Every place of a document: [holder, key].
function placesOf(value, found = []) {
  if (typeof value !== "object" || value === null) return found;
  for (const key of Object.keys(value)) {
    found.push([value, key]);
    placesOf(value[key], found);
  }
  return found;
}

const another = (pick) => structuredClone(kValues[whole(pick, kValues.length)]);

const removed = ([holder, key]) => (Array.isArray(holder) ? holder.splice(Number(key), 1) : delete holder[key]);

const kInDocument = [
  (at) => removed(at),
  ([holder, key], pick) => (holder[key] = another(pick)),
  ([holder, key], pick) => (typeof holder[key] === "number" ? (holder[key] *= [-1, 10, 1000, 0.001][whole(pick, 4)]) : (holder[key] = another(pick))),
  ([holder, key]) => {
    if (Array.isArray(holder)) holder.push(holder[key]);
    else holder[`${key}x`] = holder[key];
  },
  ([holder, key]) => {
    if (Array.isArray(holder)) return;
    holder[key.toUpperCase()] = holder[key];
    delete holder[key];
  },
];

// What no document is, in a text.
const kInText = [
  (text, pick) => text.slice(0, whole(pick, text.length)),
  (text, pick) => { const at = whole(pick, text.length); return text.slice(0, at) + text.slice(at + 1); },
  (text) => text.replace(/"([a-z_]+)": /, '"$1": 1, "$1": '),
  (text) => text.replace(/(\d+)/, "0$1"),
  (text) => text.replace(/(\d+)/, "NaN"),
  (text) => text.replace(/"format"/, '"format": 2, "format"'),
  (text) => text.replace(/\}\s*$/, "}, }"),
  (text) => `[${text}]`,
  () => "",
  () => "null",
];

// count texts made of the document; about a fifth are no JSON of an object.
export function mutated(document, count, pick) {
  const texts = [];
  for (let i = 0; i < count; ++i) {
    const copy = structuredClone(document);
    for (let steps = 1 + whole(pick, 2); steps > 0; --steps) {
      const places = placesOf(copy);
      if (places.length > 0) kInDocument[whole(pick, kInDocument.length)](places[whole(pick, places.length)], pick);
    }
    const text = JSON.stringify(copy, null, 2);
    texts.push(i % 5 === 4 ? kInText[Math.floor(i / 5) % kInText.length](text, pick) : text);
  }
  return texts;
}
