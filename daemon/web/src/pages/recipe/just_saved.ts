// Which recipe was saved in this tab last: the page that shows it after that says so, and what can be done with it next.
import { createStore } from "../../lib/store.ts";

export const justSaved = createStore<{ id: string; version: number } | null>(null);
