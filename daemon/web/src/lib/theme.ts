// Light, dark, or as the system has it.
import { createStore } from "./store.ts";

export type Theme = "auto" | "light" | "dark";

const kKey = "fvd.theme";
const kept = localStorage.getItem(kKey);

export const theme = createStore<Theme>(kept === "light" || kept === "dark" ? kept : "auto");

export function setTheme(wanted: Theme): void {
  localStorage.setItem(kKey, wanted);
  theme.set(wanted);
  applyTheme();
}

export function applyTheme(): void {
  const wanted = theme.get();
  if (wanted === "auto") delete document.documentElement.dataset["theme"];
  else document.documentElement.dataset["theme"] = wanted;
}

// What is drawn with colours of its own, as plots are, stays so on paper: it says for which ground it was made.
export const ground = (): "dark" | "light" =>
  theme.get() === "dark" || (theme.get() === "auto" && matchMedia("(prefers-color-scheme: dark)").matches) ? "dark" : "light";
