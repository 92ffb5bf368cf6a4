// Texts of the page by language. A test finds keys that one language lacks, and keys that nothing uses.
import { createStore, useStore } from "../lib/store.ts";
import type en from "./en.json";

export type Language = "en" | "de";
export type TextKey = keyof typeof en;

// Only the language that is read is fetched.
const kFiles: Record<Language, () => Promise<{ default: Record<string, string> }>> = {
  en: () => import("./en.json", { with: { type: "json" } }),
  de: () => import("./de.json", { with: { type: "json" } }),
};
let texts: Record<string, string> = {};
const kKey = "fvd.language";

function preferred(): Language {
  const kept = localStorage.getItem(kKey);
  if (kept === "en" || kept === "de") return kept;
  return navigator.language.toLowerCase().startsWith("de") ? "de" : "en";
}

export const language = createStore<Language>(preferred());

// Before anything is drawn, and whenever another language is wanted.
export async function loadTexts(wanted: Language = language.get()): Promise<void> {
  texts = (await kFiles[wanted]()).default;
  document.documentElement.lang = wanted;
  language.set(wanted);
}

export async function setLanguage(wanted: Language): Promise<void> {
  await loadTexts(wanted);
  localStorage.setItem(kKey, wanted);
}

// The text of a key with {names} replaced; numbers as the language writes them.
export function t(key: TextKey, values: Record<string, string | number> = {}): string {
  const text = texts[key] ?? key;
  return text.replace(/\{(\w+)\}/g, (whole, name: string) => {
    const value = values[name];
    return value === undefined ? whole : typeof value === "number" ? number(value) : value;
  });
}

// Text of a key that is put together, e.g. of a state; the word itself where nobody wrote a text for it.
export function tWord(prefix: string, word: string, values: Record<string, string | number> = {}): string {
  const key = `${prefix}.${word}`;
  return key in texts ? t(key as TextKey, values) : word;
}

// A number for people: the decimal sign is the language's, the digits are those of the value.
export function number(value: number, digits?: number): string {
  if (!Number.isFinite(value)) return "–";
  // Nothing is left of it but its sign.
  const shown = value === 0 || digits !== undefined && Number(value.toFixed(digits)) === 0 ? 0 : value;
  return new Intl.NumberFormat(language.get(), digits === undefined
    ? { maximumFractionDigits: 20, useGrouping: false }
    : { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false }).format(shown);
}

// Draws the component anew when the language changes.
export function useLanguage(): Language {
  return useStore(language);
}
