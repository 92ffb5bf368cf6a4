// What modules of the page touch when they are loaded, for tests that run without a browser.
const kept = new Map<string, string>();
const storage = {
  getItem: (key: string) => kept.get(key) ?? null,
  setItem: (key: string, value: string) => void kept.set(key, value),
  removeItem: (key: string) => void kept.delete(key),
};
for (const name of ["sessionStorage", "localStorage"]) {
  Object.defineProperty(globalThis, name, { value: storage, configurable: true });
}
if (!("navigator" in globalThis)) Object.defineProperty(globalThis, "navigator", { value: { language: "en" }, configurable: true });
if (!("document" in globalThis)) Object.defineProperty(globalThis, "document", { value: { documentElement: { dataset: {} } }, configurable: true });

export {};
